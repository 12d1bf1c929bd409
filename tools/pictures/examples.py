"""The gallery: each example of input/ with its body, curve and closed form."""
import collections
import pathlib

import numpy as np

from . import BLUE, GREEN, GREY, RED, body, closed, empty, legend_below

Example = collections.namedtuple("Example", "name decks title draw view rows")
EXAMPLES = {}
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDER = ROOT / ("input" if (ROOT / "input").is_dir() else "examples")

DOTS = {"ls": "", "marker": "o", "ms": 3.2}
FORM = {"lw": 1.8, "alpha": 0.75}


def example(name, title, *decks, rows=1, **view):
    """Register the function that draws the curves of an example: it gets the
    results of the decks and its axes. view: of the body, see draw_body."""
    def register(draw):
        decks_ = decks or (f"{name}/{name}",)
        EXAMPLES[name] = Example(name, decks_, title, draw, view, rows)
        return draw
    return register


# ---- frame -------------------------------------------------------------

def thumbnail(axes, job, window, place):
    """The whole body, small, with the part that is shown large."""
    inset = axes.inset_axes(place)
    edges, _ = body.boundary(job.elements)
    for edge in job.points[edges][:, :, :2]:
        inset.plot(*edge.T, color=GREY, lw=0.8)
    (x0, x1), (y0, y1) = window
    inset.plot([x0, x1, x1, x0, x0], [y0, y0, y1, y1, y0], color=RED, lw=1.2)
    inset.set_aspect("equal")
    inset.margins(0.1)
    inset.set(xticks=[], yticks=[], facecolor="#ffffffd8")
    for side in inset.spines.values():
        side.set_color("#bbbbbb")


def draw_body(figure, axes, job, inset=None, **how):
    """The body; inset: where the whole of it stands in the picture of a
    part."""
    if inset:
        how.setdefault("scale", 1.0)
    body.draw(figure, axes, job, how.pop("field", None), **how)
    if inset:
        thumbnail(axes, job, how["window"], inset)


def picture(one, results):
    """The figure of an example from the results of its decks."""
    wide = one.view.get("width", 1.0)
    figure = empty(9.6, 4.5 if one.rows == 1 else 6.2)
    figure.get_layout_engine().set(w_pad=0.08, wspace=0.05,
                                   rect=(0, 0, 0.985, 1))
    grid = figure.add_gridspec(one.rows, 2, width_ratios=(wide, 1))
    view = {k: v for k, v in one.view.items() if k not in ("width", "at")}
    draw_body(figure, figure.add_subplot(grid[:, 0]), results[0], **view)
    panels = [figure.add_subplot(grid[i, 1]) for i in range(one.rows)]
    one.draw(*results, *panels)
    for panel in panels:
        legend_below(panel, 2)
    figure.suptitle(one.title, fontsize=12)
    return figure


def readme(plane, solid):
    """The picture of the README: a plane body and a contact in space."""
    figure = empty(9.6, 4.9)
    figure.get_layout_engine().set(w_pad=0.08, wspace=0.05,
                                   rect=(0, 0, 0.985, 1))
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.12))
    body.draw(figure, left, plane)
    body.draw(figure, right, solid, elevation=-38.0, zoom=((0, 0, 0), 0.6))
    left.set_title("block on a rough floor, displacements × 50", loc="left")
    right.set_title("pressed sphere, turned about its normal", loc="left")
    return figure


def label(axes, x, y):
    axes.set_xlabel(x)
    axes.set_ylabel(y)


def by(job, *names, table="CONTACT", which=-1):
    """Columns of a table in the order of the first."""
    columns = job.table(table, which)
    order = np.argsort(columns[names[0]], kind="stable")
    return [columns[n][order] for n in names]


def tractions(axes, unit="mm", x="x"):
    label(axes, f"{x}, {unit}" if unit else x,
          "traction on the body" + (", N/mm²" if unit else ""))
    axes.set_ylim(bottom=0)


# ---- contact -----------------------------------------------------------

@example("greco", "GRECO block: pressed and pushed from the left, mu = 1",
         rows=2)
def greco(job, above, below):
    x, u, p, q = by(job, "x", "u_t", "pressure", "traction_t")
    above.plot(x, 1e3 * u, color=RED, label="Protis, 32 segments", **DOTS)
    above.plot([0, 1.25, 5, 7.5, 11.25], [28.6, 27.2, 22.8, 19.8, 15.0], "D",
               mfc="none", ms=8, color=BLUE, label="published")
    label(above, "x, mm", "sliding along the floor, µm")
    below.plot(x, p, "o-", color=BLUE, label="pressure")
    below.plot(x, np.abs(q), "o-", color=RED, label="shear traction")
    tractions(below)


@example("hertz_line", "Cylinder on a plane (Hertz)",
         window=((-0.03, 0.72), (-0.16, 0.6)), inset=(0.6, 0.6, 0.4, 0.4))
def hertz_line(job, axes):
    line, s = closed.Line(), np.linspace(0, 0.235, 300)
    x, p = by(job, "x", "pressure")
    axes.plot(s, line.pressure(s), color=BLUE, label="closed form", **FORM)
    axes.plot(x, p, color=RED, label="Protis", **DOTS)
    axes.set_xlim(0, 0.32)
    tractions(axes)


@example("hertz_goals", "Goals: what an answer is worth",
         "hertz_line/hertz_goals", scale=1.0)
def hertz_goals(job, axes):
    line = closed.Line()
    length = line.a * line.p0 * 200.0 / 210e3
    exact = {"PEAK": 1.00026235 * line.p0, "WIDE": 1.00157562 * line.a,
             "TOP": -0.00857071821 * length, "SIDE": -0.00204203522 * length}
    for k, goal in enumerate(job.json["goals"]):
        true, unit = exact[goal["goal"]], 1e3 / abs(exact[goal["goal"]])
        sign = 1.0 if true > 0 else -1.0
        value, corrected = (sign * unit * (goal[name] - true)
                            for name in ("value", "corrected"))
        axes.errorbar(k + 0.12, corrected, unit * goal["band"], color=GREEN,
                      marker="s", ms=5, capsize=4,
                      label="" if k else "value + error, band")
        axes.plot(k - 0.12, value, "o", color=RED, ms=5,
                  label="" if k else "value")
    axes.axhline(0.0, color=BLUE, label="closed form", **FORM)
    axes.set_xticks(range(4), [g["goal"] for g in job.json["goals"]])
    axes.set_yscale("symlog", linthresh=0.1)
    axes.set_ylabel("off the closed form, 1/1000")
    legend_below(axes)


@example("disc", "Disc between two planes, the upper one moves down",
         "hertz_line/disc")
def disc(job, axes):
    line, s = closed.Line(), np.linspace(-0.235, 0.235, 400)
    axes.plot(s, line.pressure(s), color=BLUE, label="closed form (Hertz)",
              **FORM)
    for contact, colour, mark in zip(job.contacts, (RED, GREEN), "o+"):
        axes.plot(contact.points[:, 0], contact.pressure, color=colour, ls="",
                  marker=mark, ms=4, label=f"Protis, {contact.name.lower()}")
    axes.set_xlim(-0.32, 0.32)
    tractions(axes)


@example("hertz_sphere", "Sphere on a plane (Hertz): axisymmetric, tetrahedra",
         "hertz_sphere/hertz_sphere_3d", "hertz_sphere/hertz_sphere",
         azimuth=225.0, elevation=22.0, zoom=((0, 0, 0.75), 0.95))
def hertz_sphere(solid, turned, axes):
    ball, s = closed.Sphere(), np.linspace(0, 0.3191, 300)
    axes.plot(s, ball.pressure(s), color=BLUE, label="closed form", **FORM)
    r, p = by(turned, "r", "pressure")
    axes.plot(r, p, color=RED, label="axisymmetric", **DOTS)
    x, y, p = by(solid, "x", "y", "pressure")
    axes.plot(np.hypot(x, y), p, "D", mfc="none", ms=5, color=GREEN,
              label="tetrahedra")
    axes.set_xlim(0, 0.45)
    tractions(axes, x="r")


@example("block_shear_3d", "Block pressed, sheared, then turned by 90 degrees, "
         "mu = 0.4", width=1.25)
def block_shear_3d(job, axes):
    _, n, x, y = job.over_time("TOTALS", "force_z", "force_x", "force_y")
    turn = np.linspace(-np.pi, 0, 200)
    axes.plot(0.4 * np.cos(turn), 0.4 * np.sin(turn), color=BLUE,
              label="cone, |T| = mu N", **FORM)
    axes.plot(x / n, y / n, "o-", color=RED, lw=1, label="Protis")
    axes.set_aspect("equal")
    axes.set_ylim(-0.45, 0.1)
    label(axes, "$T_x/N$", "$T_y/N$")


@example("lying_block", "Block that nothing but contact and friction holds",
         "lying_block/lying_block_3d", "lying_block/lying_block", width=1.25)
def lying_block(job, _, axes):
    time, x, y, z = job.over_time("TOTALS", "force_x", "force_y", "force_z")
    t = np.array([0, 1, 2.0])
    for value, load, name, colour in (
            (z, (0, 32, 32), "normal", BLUE), (x, (0, 0, -4.8), "along x", RED),
            (y, (0, 0, -3.2), "along y", GREEN)):
        axes.plot(t, load, color=colour, **FORM)
        axes.plot(time, value / 1e3, color=colour, ls="", marker="o", ms=5,
                  label=f"Protis, {name}")
    axes.plot([], [], color=GREY, label="loads", **FORM)
    label(axes, "time, s", "force of the floor, kN")


@example("spence", "Indentation with friction (Spence), nu = 0.3, mu = 0.2",
         window=((-0.02, 0.46), (-0.12, 0.4)), inset=(0.64, 0.64, 0.35, 0.35))
def spence(job, axes):
    line, a = closed.Line(), 0.98272
    s = line.a * a * np.sin(np.linspace(0, np.pi / 2, 120))
    p, q, c = closed.spence(line, 0.2, a, s)
    axes.plot(s, line.pressure(s), color=GREY, ls="--", lw=1,
              label="no friction (Hertz)")
    axes.plot(s, p, color=BLUE, label="Spence, pressure", **FORM)
    axes.plot(s, 5 * q, color=RED, label="Spence, 5 × shear", **FORM)
    x, found, shear = by(job, "x", "pressure", "traction_t")
    axes.plot(x, found, color=BLUE, label="Protis, pressure", **DOTS)
    axes.plot(x, 5 * np.abs(shear), color=RED, label="Protis, 5 × shear",
              **DOTS)
    axes.axvline(c * a * line.a, color=GREY, lw=0.8, ls=":")
    axes.text(c * a * line.a + 0.004, 80, f"stick up to {c:.3f} a", color=GREY)
    axes.set_xlim(0, 0.26)
    tractions(axes)


@example("mindlin_loop", "Pressed, sheared to and fro (Cattaneo, Mindlin)",
         rows=2, window=((-0.42, 0.42), (-0.26, 0.5)),
         inset=(0.66, 0.74, 0.33, 0.25))
def mindlin_loop(job, above, below):
    line, mu = closed.Line(), 0.3
    s = np.linspace(-line.a, line.a, 400)
    q, _ = closed.cattaneo(line, s, mu, 0.5)
    x, p, shear = by(job, "x", "pressure", "traction_t")
    above.plot(s, mu * line.pressure(s), color=GREY, ls="--", lw=1,
               label="mu p")
    above.plot(s, q, color=RED, label="Cattaneo, shear", **FORM)
    above.plot(x, np.abs(shear), color=RED, label="Protis, shear", **DOTS)
    tractions(above)
    blocks = job.tables("LOOP")
    u = np.array([b.columns["mean_u_t"][0] for b in blocks])
    force = np.array([b.columns["tangential"][0] for b in blocks])
    weight = np.r_[0.5, np.ones(len(x) - 2), 0.5]
    exact, moved = closed.loop(line, x, mu, 0.5, weight)
    below.plot(1e6 * moved, exact, color=BLUE, label="closed form", **FORM)
    below.plot(1e6 * u, force, color=RED, label="Protis", **DOTS)
    label(below, "mean displacement of the contact, nm", "force, N/mm")


@example("torsion_sphere_3d", "Pressed sphere turned about its normal (Lubkin)",
         rows=2, width=1.1, elevation=-35.0, zoom=((0, 0, 0), 0.62))
def torsion_sphere_3d(job, above, below):
    case = closed.Torsion()
    r = case.a * np.sin(np.linspace(0, np.pi / 2, 200))
    x, y, p, t1, t2 = by(job, "x", "y", "pressure", "traction_t1",
                         "traction_t2")
    above.plot(r, case.pressure(r), color=BLUE, label="Hertz, pressure", **FORM)
    above.plot(r, [case.shear(v, 0.5) for v in r], color=RED,
               label="Lubkin, shear", **FORM)
    above.plot(np.hypot(x, y), p, color=BLUE, label="Protis, pressure", **DOTS)
    above.plot(np.hypot(x, y), np.hypot(t1, t2), color=RED,
               label="Protis, shear", **DOTS)
    above.set_xlim(0, 0.4)
    tractions(above, x="r")
    c = np.linspace(0.45, 1, 80)
    below.plot(1e3 * case.angle(c), [case.torque(v) for v in c], color=BLUE,
               label="Lubkin", **FORM)
    blocks = job.tables("LOOP")
    below.plot([1e3 * b.columns["angle"][0] for b in blocks],
               [b.columns["torque"][0] for b in blocks], color=RED,
               label="Protis", **DOTS)
    slip = 3 * np.pi * case.mu * case.P * case.a / 16
    below.axhline(slip, color=GREY, ls="--",
                  lw=1, label="full slip")
    label(below, "angle, 10$^{-3}$ rad", "torque, N mm")


@example("belt", "Roller that drags a half plane, mu(t), nu = 0.3", rows=2,
         window=((-0.5, 0.5), (-0.3, 0.6)), inset=(0.66, 0.74, 0.33, 0.25))
def belt(job, above, below):
    line, mu = closed.Line(), 0.5
    x, p, q = by(job, "x", "pressure", "traction_t")
    s = np.linspace(-0.257, 0.2145, 400)
    above.plot(s, closed.sliding(line, s, mu), color=BLUE,
               label="closed form, pressure", **FORM)
    above.plot(s, mu * closed.sliding(line, s, mu), color=RED,
               label="closed form, shear", **FORM)
    above.plot(x, p, color=BLUE, label="Protis, pressure", **DOTS)
    above.plot(x, np.abs(q), color=RED, label="Protis, shear", **DOTS)
    tractions(above)
    blocks = job.tables("LOOP")
    t = np.array([b.time for b in blocks])
    below.plot([0, 1, 2], [0.2, 0.2, 0.5], color=BLUE, label="mu(t)", **FORM)
    below.plot(t, [b.columns["tangential"][0] / b.columns["normal"][0]
                   for b in blocks], color=RED, label="Protis, T/N", **DOTS)
    below.set_ylim(0, 0.6)
    label(below, "time, s", "T/N")


@example("hild_triangle", "Triangle of Hild, nu = 0.1, mu = 1", rows=2,
         width=1.2)
def hild_triangle(job, above, below):
    nu, mu, mu0, p0 = 0.1, 1.0, 2.5, 0.01
    lame = nu / ((1 + nu) * (1 - 2 * nu))
    beta = p0 * (mu - mu0) / (lame * (mu - np.sqrt((1 - nu) / nu)))
    x, p, q, u = by(job, "x", "pressure", "traction_t", "u_t")
    above.axhline(p0 - lame * beta, color=BLUE, label="closed form, both",
                  **FORM)
    above.plot(x, p, "o", color=BLUE, ms=4, label="Protis, pressure")
    above.plot(x, np.abs(q), "s", mfc="none", ms=8, color=RED,
               label="Protis, shear")
    above.set_ylim(0, 0.0042)
    tractions(above, "")
    below.plot(x, 0.002 * x - 0.02 + beta * (x - 1), color=BLUE,
               label="closed form", **FORM)
    below.plot(x, u, "o", color=RED, ms=4, label="Protis")
    label(below, "x", "displacement along the base")


@example("nonlocal_slider", "Linings that slide: nonlocal friction",
         width=1.0, window=((-2, 26), (-0.06, 0.12)), scale=1.0,
         stretch=True)
def nonlocal_slider(job, axes):
    x, q = by(job, "x", "traction_t")
    s = np.linspace(0, 25, 251)
    for start, rho, colour in ((0, 20, BLUE), (150, 10, RED), (300, 5, GREEN),
                               (450, 0, GREY)):
        mass = closed.edge_mass(s / rho) if rho else np.ones(len(s))
        axes.plot(s, 0.3 * mass, color=colour, **FORM)
        mine = (x >= start - 1e-9) & (x <= start + 25)
        axes.plot(x[mine][::3] - start, np.abs(q[mine][::3]), color=colour,
                  label=f"rho = {rho} mm" if rho else "local", **DOTS)
    axes.plot([], [], color="#444444", label="closed form", **FORM)
    axes.set_ylim(0.13, 0.31)
    label(axes, "distance from the edge, mm", "shear traction, N/mm²")


@example("nonlocal_hertz", "Cylinder that slides, nonlocal friction of 0.2 a",
         "nonlocal_slider/nonlocal_hertz",
         window=((-0.45, 0.45), (-0.24, 0.52)), inset=(0.64, 0.74, 0.33, 0.25))
def nonlocal_hertz(job, axes):
    line, mu = closed.Line(), 0.05
    x, p, q, f = by(job, "x", "pressure", "traction_t", "f_n")
    middle = np.sum(x * f) / np.sum(f)
    s = np.linspace(-line.a, line.a, 300)
    t = 2 * closed.midpoints(200) - 1
    mean = [np.mean(2 * closed.bump(t) * line.pressure(v + 0.2 * line.a * t))
            for v in s]
    axes.plot(s + middle, mu * line.pressure(s), color=GREY, ls="--", lw=1,
              label="mu p (Hertz)")
    axes.plot(s + middle, mu * np.array(mean), color=RED, label="mu R(p)",
              **FORM)
    axes.plot(x, np.abs(q), color=RED, label="Protis", **DOTS)
    axes.set_xlim(-0.3, 0.3)
    label(axes, "x, mm", "shear traction, N/mm²")
    axes.set_ylim(bottom=0)


@example("brake_pad", "Brake pad: friction tilts the pressure, wear makes it "
         "linear", rows=2, width=1.2)
def brake_pad(job, above, below):
    blocks = job.tables("CONTACT")
    for block, colour in zip((blocks[0], blocks[-1]), (GREY, RED)):
        order = np.argsort(block.columns["x"])
        above.plot(block.columns["x"][order], block.columns["pressure"][order],
                   color=colour, label=f"t = {block.time:.4g} s", **DOTS)
    x = np.array([-30.0, 30])
    above.plot(x, 2 * (1 - 12 * 0.4 * 15 * x / 3600), color=BLUE,
               label="worn in, closed form", **FORM)
    label(above, "x, mm", "pressure, N/mm²")
    above.set_ylim(bottom=0)
    time, volume = job.over_time("TOTALS", "worn_volume")
    below.plot([0, 900], [0, 10.8], color=BLUE, label="K N V t", **FORM)
    below.plot(time, volume, "o", color=RED, ms=5, label="Protis")
    label(below, "time, s", "worn volume, mm³/mm")


# ---- bodies against each other -----------------------------------------

@example("roller", "Steel roller on aluminium; two rollers, pressed and pushed",
         "roller/roller", "roller/two_rollers", rows=2,
         window=((-16, 16), (-14, 14)), inset=(0.68, 0.02, 0.32, 0.32))
def roller(one, two, above, below):
    E = 2 / (1 / 70e3 + 1 / 210e3)  # of a plane that is rigid
    line, s = closed.Line(50.0, 35e3, E / 2), np.linspace(-6.3, 6.3, 400)
    x, p = by(one, "x", "pressure")
    above.plot(s, line.pressure(s), color=BLUE, label="Hertz", **FORM)
    above.plot(x, p, color=RED, label="Protis", **DOTS)
    above.set_xlim(-8, 8)
    tractions(above)
    line, s = closed.Line(4.0, 10.0, 100.0), np.linspace(-0.69, 0.69, 500)
    x, p, q = by(two, "x", "pressure", "traction_t")
    below.plot(s, 0.2 * line.pressure(s), color=GREY, ls="--", lw=1,
               label="mu times the pressure (Hertz)")
    below.plot(s, closed.cattaneo(line, s, 0.2, 0.468)[0], color=BLUE,
               label="shear (Cattaneo, Mindlin)", **FORM)
    below.plot(x, np.abs(q), color=RED, label="Protis", **DOTS)
    below.set_xlim(-0.9, 0.9)
    tractions(below, "")


@example("press_fit", "Press fit: ring of 32 faces in a hub of 45, plane stress",
         field="stress_yy", scale=100.0)
def press_fit(job, axes):
    x, y, p = by(job, "x", "y", "pressure")
    axes.axhline(63, color=BLUE, label="Lamé", **FORM)
    axes.plot(np.degrees(np.arctan2(y, x)), p, color=RED, label="Protis",
              **DOTS)
    label(axes, "angle, degrees", "pressure at the seat, N/mm²")
    axes.set_ylim(60, 66)


@example("arch", "Arch of ten voussoirs, a little thicker than it must be",
         field="stress_yy", width=1.2)
def arch(job, axes):
    c = job.table("CONTACT")
    angle = np.degrees(np.arctan2(c["y"], c["x"]))
    depth = np.hypot(c["x"], c["y"])
    shares = {}
    for a, r, f in zip(np.round(angle, 3), depth, c["f_n"]):
        w = shares.setdefault(a, [0.0, 0.0])
        w[0] += f
        w[1] += f * r
    found = np.array([(a, m / f) for a, (f, m) in sorted(shares.items())])
    for r, text in ((1 - 0.109 / 2, "intrados"), (1 + 0.109 / 2, "extrados")):
        axes.axhline(r, color=GREY, lw=1)
        axes.text(90, r, text, va="bottom" if r > 1 else "top", ha="center")
    axes.plot(*found.T, color=RED, label="thrust at the joints", marker="o",
              ms=4)
    label(axes, "angle, degrees", "radius")
    axes.set_ylim(0.93, 1.07)


@example("crack", "Closed crack with friction, and one closed in part",
         "crack/crack", "crack/partly_closed", rows=2,
         window=((-1.6, 1.6), (-1.6, 1.6)), inset=(0.7, 0.0, 0.3, 0.3))
def crack(closed_one, partly, above, below):
    def slipped(x):
        return 4 * 0.91 / 1e3 * 0.35801 * closed.root(1 - x ** 2)

    x, y, s = by(closed_one, "x", "y", "slip")
    along, line = np.copysign(np.hypot(x, y), x), np.linspace(-1, 1, 300)
    above.plot(line, 1e3 * slipped(line), color=BLUE, label="closed form",
               **FORM)
    above.plot(along, 1e3 * np.abs(s), color=RED, label="Protis", **DOTS)
    label(above, "along the crack", "slip, 10$^{-3}$")
    x, p, gap = by(partly, "x", "pressure", "gap")
    below.plot(x, 1e3 * gap, color=RED, label="opening, 10$^{-3}$", **DOTS)
    below.plot(x, p, color=BLUE, label="pressure", **DOTS)
    below.axvline(-1 / 3, color=GREY, ls="--", lw=1, label="x = -1/3 (Bui)")
    label(below, "x", "closed in part")


# ---- materials ---------------------------------------------------------

@example("creep_block", "Maxwell block on a rough floor: creep, relaxation",
         "creep_block/creep_block", "creep_block/held_block", rows=2)
def creep_block(crept, held, above, below):
    x, u = by(crept, "x", "u_t", which=0)
    above.plot(x, 1e3 * u, color=GREY, ls="--", lw=1, label="elastic, t = 0")
    above.plot(x, 2e3 * u, color=BLUE, label="twice that", **FORM)
    x, u = by(crept, "x", "u_t")
    above.plot(x, 1e3 * u, color=RED, label="Protis, t = tau", **DOTS)
    label(above, "x, mm", "sliding, µm")
    time, n, q = held.over_time("TOTALS", "normal", "force_x")
    start = int(np.argmin(np.abs(time - 1)))
    t = np.linspace(1, 11, 200)
    for value, colour, name in ((n, BLUE, "normal"), (q, RED, "friction")):
        below.plot(t, value[start] * np.exp(-(t - 1) / 4), color=colour, **FORM)
        below.plot(time, value, color=colour, label=f"Protis, {name}", **DOTS)
    below.plot([], [], color="#444444", label="closed form", **FORM)
    label(below, "time, s", "force, N/mm")


@example("lee_radok", "Maxwell cylinder that sinks onto a plane (Lee, Radok)",
         rows=2, window=((-0.02, 0.62), (-0.14, 0.52)),
         inset=(0.62, 0.72, 0.36, 0.27))
def lee_radok(job, above, below):
    line, tau = closed.Line(P=1.0, E=1e3), 2.0
    time, a = job.over_time("ZONES", "x_to")
    t = np.linspace(0, 10, 200)
    above.plot(t, line.a * np.sqrt(1 + t / tau), color=BLUE,
               label="closed form",
               **FORM)
    above.plot(time - 1, a, color=RED, label="Protis", **DOTS)
    above.set_ylim(0, 0.3)
    label(above, "time", "half-width of the contact")
    s = np.linspace(0, 0.2637, 250)
    x, p = by(job, "x", "pressure")
    below.plot(s, line.pressure(s), color=GREY, ls="--", lw=1,
               label="at once (Hertz)")
    below.plot(s, closed.lee_radok(line, tau, s, 10.0), color=BLUE,
               label="closed form, t = 5 tau", **FORM)
    below.plot(x, p, color=RED, label="Protis", **DOTS)
    below.set_xlim(0, 0.3)
    tractions(below, "")


@example("norton_ring", "Tube under inner pressure: steady creep, n = 5",
         field="stress_tt", scale=1.0, turn=270.0)
def norton_ring(job, axes):
    def stresses(r, n):
        power = (2 / r) ** (2 / n)
        whole = 100 / (2 ** (2 / n) - 1)
        return -whole * (power - 1), whole * (1 - (1 - 2 / n) * power)

    s = np.linspace(1, 2, 200)
    for k, (colour, name) in enumerate(((RED, "radial"), (BLUE, "hoop"))):
        axes.plot(s, stresses(s, 1.0)[k], color=GREY, ls="--", lw=1,
                  label="elastic (Lamé)" if k else None)
        axes.plot(s, stresses(s, 5.0)[k], color=colour,
                  label=f"steady, {name}", **FORM)
        r, found = by(job, "r", ("stress_rr", "stress_tt")[k], table="ELEMENTS")
        axes.plot(r, found, color=colour, label=f"Protis, {name}", **DOTS)
    label(axes, "radius", "stress at the end")


@example("chaboche_cycle", "Chaboche's law: ten cycles of 0.5 % strain",
         field="stress_yy", scale=20.0, width=0.8)
def chaboche_cycle(job, axes):
    _, eps, sigma = closed.chaboche(5e-3, 10)
    axes.plot(100 * eps, sigma, color=BLUE, label="differential equations",
              **FORM)
    _, e, s = job.over_time("ELEMENTS", "strain_yy", "stress_yy")
    axes.plot(100 * e[::4], s[::4], color=RED, label="Protis", **DOTS)
    label(axes, "strain, %", "stress, N/mm²")


@example("periodic_viscous", "Maxwell bar on a floor that moves: limit cycle",
         rows=2, width=0.8)
def periodic_viscous(job, above, below):
    t, down, p = closed.hanging_bar(6)
    time, found = job.over_time("CONTACT", "pressure")
    early, last = time <= 6, time > 19
    above.plot(t, p, color=BLUE, label="differential equation", **FORM)
    above.plot(time[early][::3], found[early][::3], color=RED, label="Protis",
               **DOTS)
    above.axhline(3.2950371, color=GREY, ls="--", lw=1, label="limit cycle")
    label(above, "periods", "pressure")
    below.plot(1e3 * down, p, color=BLUE, label="from rest", **FORM)
    below.plot(3 * np.sin(2 * np.pi * time[last]), found[last], color=RED,
               label="Protis, period 20", **DOTS)
    label(below, "floor moved down, 10$^{-3}$", "pressure")


@example("relaxing_seal", "Seal: closes hot, relaxes, opens when it cools",
         width=0.8, scale=20.0, at=1.0)
def relaxing_seal(job, axes):
    E, alpha, gap, tau = 2e5, 1.2e-5, 1e-3, 1000.0
    t = np.r_[np.linspace(0, 1, 50), np.linspace(1, 1 + tau, 300),
              np.linspace(1 + tau, 2 + tau, 50)]
    heat = 100 * np.clip(np.minimum(t, 2 + tau - t), 0, 1)
    lost = (100 * alpha - gap) * (1 - np.exp(-np.clip(t - 1, 0, tau) / tau))
    axes.plot(t, E * np.maximum(alpha * heat - gap - lost, 0), color=BLUE,
              label="closed form", **FORM)
    time, n = job.over_time("TOTALS", "normal")
    axes.plot(time, n / (np.pi * (10.5 ** 2 - 100)), "o", color=RED, ms=4,
              label="Protis")
    label(axes, "time (heating and cooling take 1)", "pressure on the lid")


@example("tempered_strip", "Tempered glass strip: stresses left when cold",
         field="stress_xx", scale=1.0, width=0.8)
def tempered_strip(job, axes):
    profile = FOLDER / "tempered_strip/profile.txt"
    if profile.is_file():  # not installed
        y, s = np.loadtxt(profile, comments="#").T[:2]
        axes.plot(y, s, color=BLUE, label="differential equations", **FORM)
    y, s = by(job, "y", "stress_xx", table="ELEMENTS")
    axes.plot(y, s, color=RED, label="Protis", **DOTS)
    axes.axhline(0, color=GREY, lw=0.8)
    label(axes, "y, mm (0: middle, 1: surface)",
          "stress along the strip, N/mm²")
