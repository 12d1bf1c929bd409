"""The body with its mesh, deformed, its obstacles and what its contacts do."""
import numpy as np
from matplotlib import cm, collections, colors, lines

from . import BLUE, GREY, OPEN, SLIP, STICK, legend_below
from .results import STATUS

MAP = colors.LinearSegmentedColormap.from_list(
    "load", ["#fffde0", "#d9efb6", "#8fd3b8", "#41a9c4", "#2276b4", "#26418f"])
COLOURS = {0: OPEN, 1: SLIP, 2: STICK}
MARKS = {0: "o", 1: "^", 2: "s"}


def title_of(name):
    """What the colours mean, in words."""
    names = {"mises": "von Mises stress", "u": "displacement",
             "stress_tt": "hoop stress"}
    if name in names:
        return names[name]
    return name.replace("_", " ")


def comma(unit):
    return f", {unit}" if unit else ""


def meaning(contact, status):
    """Of a status, in a word; what touches without friction does not stick."""
    rough = np.any(contact.limit > 0) or np.any(contact.slides != 0)
    return "in contact" if status == 1 and not rough else STATUS[status]


def default_field(job):
    return next((n for n in ("mises", "u") if job.has(n)), None)


def element_values(job, name):
    """A field per element; a vector by its length, points by their mean."""
    values = job.field(name)
    if values.ndim == 2 and values.shape[1] == 3:
        values = np.linalg.norm(values, axis=1)
    if len(values) == len(job.points) != len(job.elements):
        values = values[job.elements].mean(axis=1)
    return values


def boundary(elements):
    """Faces that one element has, and that element of each."""
    n = elements.shape[1]
    faces = np.concatenate([np.delete(elements, i, axis=1) for i in range(n)])
    owner = np.tile(np.arange(len(elements)), n)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0,
                                return_index=True, return_counts=True)
    return faces[first[count == 1]], owner[first[count == 1]]


def magnification(job):
    """How many times larger displacements are drawn: rounded, 1 where gaps at
    the start would be drawn as deep dents."""
    size = np.ptp(job.points, axis=0).max()
    largest = np.abs(job.field("u")).max()
    if largest <= 0:
        return 1.0
    u = job.field("u")
    gaps = [np.abs(c.gap + np.sum(u[c.node] * c.normal, axis=1)).max()
            for c in job.contacts]
    if max(gaps, default=0) > 0.02 * largest:
        return 1.0
    exact = 0.06 * size / largest
    step = 10 ** np.floor(np.log10(exact))
    return max(1.0, step * max(m for m in (1, 2, 5) if m * step <= exact))


def norm_of(values, symmetric=None):
    """Colours from zero to nearly the largest, or both sides of zero."""
    top = np.percentile(np.abs(values), 99.8) or 1.0
    if np.ptp(values) < 0.02 * top:
        top *= 1.6  # one colour, not the darkest
    if symmetric is None:
        symmetric = values.min() < -1e-3 * top
    return colors.Normalize(-top if symmetric else 0.0, top), symmetric


def colour_bar(figure, axes, norm, palette, label, extend="neither"):
    """Beside the axes and as high; above where the axes are flat."""
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    shown = cm.ScalarMappable(norm, palette)
    if axes.get_aspect() != "auto" and y1 - y0 < 0.55 * (x1 - x0):
        bar = figure.colorbar(shown, ax=axes, label=label, extend=extend,
                              location="top", shrink=0.8, aspect=30)
    else:
        own = axes.inset_axes([1.03, 0.0, 0.045, 1.0])
        bar = figure.colorbar(shown, cax=own, label=label, extend=extend)
    bar.outline.set_visible(False)
    return bar


def label_of(job, name):
    return title_of(name) + comma(job.unit(name))


# ---- two dimensions ----------------------------------------------------------

def line_of(contact, points):
    """Nodes of a contact in the order in which its faces join them, one list a
    connected part; a closed line ends where it began."""
    ends = {}
    for a, b in contact.faces:
        ends.setdefault(a, []).append(b)
        ends.setdefault(b, []).append(a)
    left, parts = set(range(len(points))), []
    while left:
        tips = [i for i in left if len(ends.get(i, [])) < 2]
        at = min(tips or left, key=lambda i: tuple(points[i]))
        part = [at]
        left.discard(at)
        while True:
            after = [j for j in ends.get(at, []) if j in left]
            if not after:
                break
            at = after[0]
            part.append(at)
            left.discard(at)
        if len(part) > 2 and part[0] in ends.get(part[-1], []):
            part.append(part[0])
        parts.append(np.array(part))
    return parts


def obstacle_2d(axes, surface, normal, depth):
    """A line with ticks on the obstacle's side; depth: (x, y) of a tick."""
    axes.plot(*surface.T, color="#333333", lw=1.3, zorder=5)
    steps = np.linalg.norm(np.diff(surface, axis=0), axis=1)
    along = np.r_[0, np.cumsum(steps)]
    at = np.arange(0.25, along[-1] / depth[0], 0.5) * depth[0]
    foot = np.array([np.interp(at, along, surface[:, k]) for k in (0, 1)]).T
    out = np.array([np.interp(at, along, normal[:, k]) for k in (0, 1)]).T
    side = np.array([-out[:, 1], out[:, 0]]).T
    axes.add_collection(collections.LineCollection(
        np.stack([foot, foot + depth * (out + 0.6 * side)], axis=1),
        colors="#444444", lw=0.8, zorder=4))


def pressure_2d(axes, foot, out, share):
    """The pressure over a line, as lengths share*out."""
    tip = foot + out * share[:, None]
    axes.fill(*np.concatenate([foot, tip[::-1]]).T, color=BLUE, alpha=0.25,
              lw=0,
              zorder=3)
    near = np.convolve(share > 0, [1, 1, 1])[1:-1] > 0
    tip[~near] = np.nan
    axes.plot(*tip.T, color=BLUE, lw=1.2, zorder=6)


def marks(axes, contact, points, shown, size):
    """Nodes that are shown in the marks of their statuses."""
    for k in COLOURS:
        mine = (contact.status == k) & shown
        if mine.any():
            axes.plot(*points[mine].T, MARKS[k], color=COLOURS[k], ms=size,
                      mec="#222222", mew=0.1 * size, zorder=7,
                      label=meaning(contact, k))


def contact_2d(axes, job, scale, spans):
    """Obstacle, pressure and status of each contact; spans: of what is shown
    along x and y."""
    most = max((c.pressure.max() for c in job.contacts), default=0)
    for contact in job.contacts:
        points = (contact.points
                  + scale * job.field("u")[contact.node])[:, :2]
        normal = contact.normal[:, :2]
        faced = points + scale * contact.gap[:, None] * normal
        for part in line_of(contact, contact.points):
            if job.has("contact_force"):  # bodies face each other
                continue
            obstacle_2d(axes, faced[part], normal[part], 0.034 * spans)
            if most > 0:
                pressure_2d(axes, faced[part], 0.2 * spans * normal[part],
                            contact.pressure[part] / most)
        apart = np.ptp(points, axis=0).max() / max(len(points), 1)
        marks(axes, contact, points, True,
              np.clip(250 * apart / spans[0], 1.2, 4.6))


def moved(job, scale):
    """The largest displacement, as drawn."""
    return scale * np.linalg.norm(job.field("u"), axis=1).max()


def keys(axes, job, pressure=True):
    """Handles of the legend: the largest pressure, and what has been drawn."""
    found = []
    most = max((c.pressure.max() for c in job.contacts), default=0)
    if pressure and most > 0:
        text = f"pressure ≤ {most:.4g} {job.contacts[0].unit}".rstrip()
        found.append(lines.Line2D([], [], color=BLUE, lw=1.5, label=text))
    handles, labels = axes.get_legend_handles_labels()
    for label, drawn in dict(zip(labels, handles)).items():
        if drawn.__class__ is lines.Line2D:  # marks as large as can be read
            drawn = lines.Line2D([], [], ls="", marker=drawn.get_marker(),
                                 color=drawn.get_color(), mec="#222222",
                                 mew=0.5, ms=4.6, label=label)
        found.append(drawn)
    return found


def mesh_2d(axes, job, points, values, norm, palette, seen):
    """Elements in colours, their edges as thin as they are small."""
    shape = points[job.elements][:, :, :2]
    inside = ((shape.max(axis=1) > seen[:, 0]) &
              (shape.min(axis=1) < seen[:, 1])).all(axis=1)
    size = np.sqrt(np.prod(seen[:, 1] - seen[:, 0]) / max(inside.sum(), 1))
    fine = size / (seen[:, 1] - seen[:, 0]).max()
    face = collections.PolyCollection(
        shape[inside], array=values[inside] if values is not None else None,
        cmap=palette, norm=norm, lw=np.clip(12 * fine, 0.2, 0.45),
        edgecolor="#20304090" if fine > 0.006 else "face", zorder=2)
    if values is None:
        face.set_facecolor("#e8edf3")
    face.set_rasterized(inside.sum() > 4000)
    axes.add_collection(face)


def draw_2d(axes, job, name=None, scale=None, window=None, stretch=False):
    """Body and contact in a plane; (norm, palette, scale) of what was drawn.
    window: ((x0, x1), (y0, y1)); the whole body and its contacts if None;
    stretch: thin bodies over the whole height."""
    name = name or default_field(job)
    scale = magnification(job) if scale is None else scale
    points = job.points + scale * job.field("u")
    values = element_values(job, name) if name else None
    seen = np.array([[points[:, k].min(), points[:, k].max()] for k in (0, 1)])
    if window is not None:
        seen = np.array(window, float)
    spans = seen[:, 1] - seen[:, 0]
    wide = spans.max()
    if not stretch:
        spans = np.full(2, wide)
    shown = values
    if values is not None and window is not None:
        middle = points[job.elements].mean(axis=1)[:, :2]
        in_view = ((middle > seen[:, 0]) & (middle < seen[:, 1])).all(axis=1)
        shown = values[in_view] if in_view.any() else values
    norm, both = norm_of(shown) if values is not None else (None, False)
    palette = "RdBu_r" if both else MAP
    mesh_2d(axes, job, points, values, norm, palette, seen)
    edges, _ = boundary(job.elements)
    axes.add_collection(collections.LineCollection(
        points[edges][:, :, :2], colors="#203040", lw=0.9, zorder=3))
    if moved(job, scale) > 0.005 * wide:
        axes.add_collection(collections.LineCollection(
            job.points[edges][:, :, :2], colors="#a0a0a0", lw=1.0,
            zorder=1, label="before loading"))
    contact_2d(axes, job, scale, spans)
    axes.set_aspect("auto" if stretch else "equal")
    axes.grid(False)
    if window is not None:
        axes.set_xlim(*seen[0])
        axes.set_ylim(*seen[1])
    else:
        axes.autoscale_view()
    axes.set_xlabel(job.axes[0] + comma(job.length))
    axes.set_ylabel(job.axes[1] + comma(job.length))
    return norm, palette, scale


# ---- three dimensions --------------------------------------------------------

def camera(job, elevation=None, azimuth=-60.0):
    """Rows right, up, towards the eye; from below where the contacts look down,
    unless an elevation (degrees) is given."""
    if elevation is None:
        down = sum((c.normal.sum(axis=0) for c in job.contacts),
                   np.zeros(3))
        elevation = -25.0 if down[2] < -1e-3 * np.abs(down).max() else 25.0
        if job.contacts and abs(down[2]) < np.hypot(down[0], down[1]):
            azimuth = np.degrees(np.arctan2(down[1], down[0])) - 25
    a, e = np.radians([azimuth, elevation])
    eye = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.array([right, np.cross(eye, right), eye])


def lit(face_points, view, rgba):
    """Colours in the light from above the eye."""
    across = np.cross(face_points[:, 1] - face_points[:, 0],
                      face_points[:, 2] - face_points[:, 0])
    across /= np.linalg.norm(across, axis=1)[:, None] + 1e-300
    light = view.T @ np.array([-0.5, 0.35, 0.8])
    shade = 0.84 + 0.16 * np.abs(across @ (light / np.linalg.norm(light)))
    return np.clip(rgba * np.c_[shade, shade, shade, np.ones(len(shade))], 0, 1)


def outward(faces, owner, job, points):
    """Unit normals that look away from the element of each face."""
    p = points[faces]
    across = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    inside = points[job.elements[owner]].mean(axis=1) - p.mean(axis=1)
    across *= -np.sign(np.sum(across * inside, axis=1))[:, None]
    return across / (np.linalg.norm(across, axis=1)[:, None] + 1e-300)


def frame_3d(axes, view, size):
    """A small triad of axes at the lower left, and how large things are."""
    axes.set_aspect("equal")
    axes.axis("off")
    foot = {"xy": (0.05, -0.1), "xycoords": "axes fraction",
            "textcoords": "offset points", "color": GREY}
    for k, name in enumerate("xyz"):
        tip = 22 * view[:2, k]
        axes.annotate("", xytext=tip, arrowprops={
            "arrowstyle": "<|-", "lw": 1, "color": GREY, "shrinkA": 0,
            "shrinkB": 0}, **foot)
        if np.linalg.norm(view[:2, k]) > 0.2:
            axes.annotate(name, xytext=tip + 7 * view[:2, k], ha="center",
                          va="center", fontsize=9, **foot)
    axes.text(0.5, -0.02, size, transform=axes.transAxes, ha="center",
              va="top", color=GREY, fontsize=9)


def size_of(spans, unit):
    return " × ".join(f"{s:.4g}" for s in spans) + f" {unit}".rstrip()


def in_sight(flat, faces, at, normal):
    """Which points no face hides from the eye. flat [n, 3]: right, up, depth of
    the nodes of the faces; at [m, 3]: of the points; normal [m]: share of
    their outward normals towards the eye."""
    a, b, c = (flat[faces[:, k]] for k in range(3))
    (e, f), whole = ((b - a)[:, :2].T, (c - a)[:, :2].T), np.ptp(flat[:, 2])
    det = e[0] * f[1] - e[1] * f[0]
    good = np.abs(det) > 1e-9 * np.abs(det).max()
    shown = normal > 0
    for i in np.flatnonzero(shown):
        d = (at[i] - a)[:, :2].T
        with np.errstate(divide="ignore", invalid="ignore"):
            s = (d[0] * f[1] - d[1] * f[0]) / det
            t = (e[0] * d[1] - e[1] * d[0]) / det
        inside = good & (s > -0.01) & (t > -0.01) & (s + t < 1.01)
        depth = a[:, 2] + s * (b - a)[:, 2] + t * (c - a)[:, 2]
        shown[i] = not np.any(depth[inside] > at[i, 2] + 1e-3 * whole)
    return shown


def draw_3d(axes, job, name=None, scale=None, elevation=None, azimuth=-60.0,
            zoom=None):
    """Surface of the body in colours, contact nodes in those of their status;
    (norm, palette, scale). elevation, azimuth: of the eye, degrees; zoom:
    (centre, radius) of the part that is shown."""
    name = name or default_field(job)
    scale = magnification(job) if scale is None else scale
    view = camera(job, elevation, azimuth)
    points = job.points + scale * job.field("u")
    faces, owner = boundary(job.elements)
    seen = outward(faces, owner, job, points) @ view[2] > 0
    if zoom is not None:
        off = points[faces].mean(axis=1) - zoom[0]
        seen &= np.linalg.norm(off @ view[:2].T, axis=1) < 1.6 * zoom[1]
    faces, owner = faces[seen], owner[seen]
    values = element_values(job, name) if name else np.zeros(len(job.elements))
    norm, both = norm_of(values[owner])
    palette = "RdBu_r" if both else MAP
    rgba = cm.ScalarMappable(norm, palette).to_rgba(values[owner])
    order = np.argsort(points[faces].mean(axis=1) @ view[2])
    rgba = lit(points[faces], view, rgba)
    edge = min(0.35, 40 / np.sqrt(len(faces)) / 10)
    shapes = collections.PolyCollection(
        (points @ view[:2].T)[faces[order]], facecolors=rgba[order],
        edgecolors="#20304099", lw=edge, zorder=2)
    shapes.set_rasterized(len(faces) > 3000)
    axes.add_collection(shapes)
    for contact in job.contacts:
        place = points[contact.node] @ view.T
        shown = in_sight(points @ view.T, faces, place,
                         contact.normal @ view[2])
        marks(axes, contact, place[:, :2], shown,
              np.clip(60 / np.sqrt(len(place)), 1.2, 4))
    if zoom is not None:
        centre = view[:2] @ zoom[0]
        axes.set_xlim(*(centre[0] + zoom[1] * np.array([-1, 1])))
        axes.set_ylim(*(centre[1] + zoom[1] * np.array([-1, 1])))
    else:
        axes.autoscale_view()
    frame_3d(axes, view, size_of(np.ptp(job.points, axis=0), job.length)
             if zoom is None else f"{2 * zoom[1]:g} {job.length} across")
    return norm, palette, scale


def revolved(job, points, values, turn, parts=48):
    """Polygons of a body of revolution that lacks a wedge, and their values:
    its outer surfaces and the two cuts. Rows of polygons: 4 corners."""
    def at(p, angle):
        return np.stack([p[..., 0] * np.cos(angle), p[..., 0] * np.sin(angle),
                         p[..., 1]], axis=-1)

    edges, owner = boundary(job.elements)
    angles = np.linspace(0, turn, parts + 1)
    shapes, found = [], []
    for a, b in zip(angles[:-1], angles[1:]):
        p = points[edges]
        shapes.append(np.concatenate([at(p, a), at(p, b)[:, ::-1]], axis=1))
        found.append(values[owner])
    for angle in (0.0, turn):
        p = at(points[job.elements], angle)
        shapes.append(np.concatenate([p, p[:, :1]], axis=1))
        found.append(values)
    return np.concatenate(shapes), np.concatenate(found)


def draw_round(axes, job, name=None, scale=None, elevation=30.0, azimuth=-45.0,
               turn=270.0):
    """An axisymmetric body in space, cut open; (norm, palette, scale)."""
    scale = magnification(job) if scale is None else scale
    view = camera(job, elevation, azimuth)
    values = element_values(job, name)
    shapes, found = revolved(job, job.points + scale * job.field("u"), values,
                             np.radians(turn))
    norm, both = norm_of(values)
    palette = "RdBu_r" if both else MAP
    rgba = lit(shapes, view, cm.ScalarMappable(norm, palette).to_rgba(found))
    order = np.argsort(shapes.mean(axis=1) @ view[2])
    axes.add_collection(collections.PolyCollection(
        (shapes @ view[:2].T)[order], facecolors=rgba[order],
        edgecolors=np.clip(rgba[order] * [0.8, 0.8, 0.8, 1], 0, 1), lw=0.3))
    axes.autoscale_view()
    wide = 2 * job.points[:, 0].max()
    frame_3d(axes, view, size_of((wide, wide, np.ptp(job.points[:, 1])),
                                 job.length))
    return norm, palette, scale


def draw(figure, axes, job, name=None, legend=True, **how):
    """The body in an axes, with its bar of colours and its legend."""
    flat = job.dimension == 2 and "turn" not in how
    name = name or default_field(job)
    method = draw_2d if flat else draw_round if "turn" in how else draw_3d
    norm, palette, scale = method(axes, job, name, **how)
    if name:
        colour_bar(figure, axes, norm, palette, label_of(job, name), "max")
    if scale != 1:
        axes.set_title(f"displacements × {scale:g}", loc="left")
    if legend:
        alone = flat and not job.has("contact_force")
        legend_below(axes, handles=keys(axes, job, alone))
    return scale
