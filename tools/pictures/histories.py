"""Curves over time, loops, forces, and what errors and stages cost."""
import math

from deck_tools import compared, load_done
from matplotlib.ticker import LogLocator, NullFormatter

from . import BLUE, GREEN, RED, empty, legend_below, new, plain
from .results import Missing

COLOURS = (BLUE, RED, GREEN, "#6b4a9c", "#c77700", "#0b7a87")


def time_label(job):
    unit = ""
    try:
        unit = job.h5["history/time"].attrs.get("unit", b"").decode()
    except (Missing, KeyError):
        pass
    return "time" + (f", {unit}" if unit else "")


def over_time(job, table, names, title=None):
    """Columns of the first row of each block of a table."""
    time, *values = job.over_time(table, *names)
    first = job.tables(table)[0]
    units = first.units
    contacts = first.columns.get("contact", [])
    of = f" of {contacts[0]}" if len(set(contacts)) > 1 else ""
    figure, axes = new(7.5, 4.4)
    axes = axes[0, 0]
    for k, (name, value) in enumerate(zip(names, values)):
        axes.plot(time, value, "o-", color=COLOURS[k % 6], label=name + of)
    axes.set_xlabel(time_label(job))
    shown = {units[n] for n in names}
    axes.set_ylabel(", ".join(sorted(shown)))
    if title:
        axes.set_title(plain(title))
    legend_below(axes)
    return figure


def loop(job, contact, x, y, title=None):
    """Two columns of the LOOP tables of a contact against each other."""
    found = {x: [], y: []}
    names = set()
    for block in job.tables("LOOP"):
        for name in (x, y):
            if name not in block.columns:
                raise Missing(f"LOOP has no column {name}; it has "
                              f"{', '.join(block.columns)}")
        for row, name in enumerate(block.columns["contact"]):
            names.add(name)
            if compared(name) == compared(contact):
                for key in (x, y):
                    found[key].append(block.columns[key][row])
    if not found[x]:
        raise Missing(f"no contact {contact} in the LOOP tables, which have "
                      f"{', '.join(sorted(names))}")
    units = job.tables("LOOP")[0].units
    figure, axes = new(6.0, 4.6)
    axes[0, 0].plot(found[x], found[y], "o-", color=BLUE)
    axes[0, 0].set_xlabel(f"{x}, {units[x]}")
    axes[0, 0].set_ylabel(f"{y}, {units[y]}")
    if title:
        axes[0, 0].set_title(plain(title))
    return figure


def forces(job):
    """Resultants of each contact over time, a panel each; None without."""
    if not job.file("h5").is_file() or "totals" not in job.h5:
        return None
    totals = job.h5["totals"]
    time = job.h5["history/time"][...]
    names = [c.name for c in job.contacts if c.name in totals] or list(totals)
    figure = empty(4.2 * len(names) + 2, 3.6)
    axes = figure.subplots(1, len(names), squeeze=False)
    for panel, contact in zip(axes[0], names):
        group = totals[contact]
        shown = [n for n in group if n.startswith("force_")]
        for k, name in enumerate(shown):
            panel.plot(time, group[name][:len(time)], "o-",
                       color=COLOURS[k % 6],
                       label=name)
        unit = group[shown[0]].attrs.get("unit", b"").decode() if shown else ""
        panel.set_title(plain(contact))
        panel.set_xlabel(time_label(job))
        panel.set_ylabel(f"force on the body, {unit}")
        legend_below(panel)
    return figure


def errors_of(job):
    """{which: (percent, CPU seconds of the work, of the estimate)}."""
    accuracy = job.json.get("accuracy", {})
    found = {}
    for key in accuracy:
        name, _, rest = key.partition("_error_")
        if rest == "percent":
            found[name] = (accuracy[key],
                           accuracy.get(f"{name}_error_reached_cpu"),
                           accuracy.get(f"{name}_error_estimate_cpu"))
    return found


def costs(job):
    """Left: each error against the CPU seconds of the work that decides it;
    right: the stages that cost."""
    stages = [s for s in job.json.get("cost", {}).get("stages", [])
              if s.get("cpu", 0) > 0]  # none with --no-timing
    if not stages:
        return None
    stages = sorted(stages, key=lambda s: s["cpu"])[-12:]
    found = {k: v for k, v in errors_of(job).items()
             if all(isinstance(x, (int, float)) and x > 0 for x in v[:2])}
    figure, axes = new(9.0, 3.8, 2 if found else 1)
    axes = axes[0]
    if found:
        for k, (name, (error, cpu, _)) in enumerate(found.items()):
            axes[0].loglog(cpu, error, "os^D"[k % 4], ms=8, label=name,
                           color=COLOURS[k % 6])
        axes[0].set_xlabel("CPU time of the work that decides it, s")
        axes[0].set_ylabel("error, % of the energy norm")
        axes[0].margins(0.3)
        legend_below(axes[0])
    axes[-1].barh([s["stage"] for s in stages], [s["cpu"] for s in stages],
                  color=BLUE, height=0.65)
    axes[-1].set_xlabel("CPU time of the stage, s")
    axes[-1].grid(axis="y", visible=False)
    return figure


def solvers(path):
    """CPU time against the error of u, a curve a method, a panel a coefficient
    of friction, for the largest 2-D problem of a table of make
    bench-solvers."""
    rows = [line.split() for line in open(path, encoding="utf-8")]
    rows = [r for r in rows if len(r) > 10 and r[1] == "2D"
            and r[-1] == "converged"]
    if not rows:
        raise Missing(f"{path}: no rows of 2-D problems that converged")
    size = max(int(r[2]) for r in rows)
    rows = [r for r in rows if int(r[2]) == size]
    values = sorted({float(r[3]) for r in rows})
    methods = sorted({r[0] for r in rows})
    figure, axes = new(3.6 * len(values) + 0.6, 4.6, len(values))
    for panel, mu in zip(axes[0], values):
        for k, method in enumerate(methods):
            points = sorted((max(float(r[10]), 1e-16), float(r[7]))
                            for r in rows if r[0] == method
                            and float(r[3]) == mu)
            if points:
                panel.loglog(*zip(*points), marker="osv^D*Px"[k % 8], ls=(
                    "-", "--")["/" in method], color=COLOURS[k % 6],
                    lw=3 if method == "auto" else 1.3, label=method)
        panel.set_xlim(1, 1e-17)
        panel.set_title(f"{size} unknowns, mu = {mu:g}")
        panel.set_xlabel("largest error of u over largest u")
    axes[0, 0].set_ylabel("CPU time, s")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center",
                  ncol=min(6, math.ceil(len(labels) / 2)))
    return figure


def goals(folder, pairs):
    """Error of each goal, relative to its exact value, against CPU time: a
    curve for each study of tools/study in the folder, uniform meshes first."""
    try:
        exact = {name: float(x) for name, x in (p.split("=") for p in pairs)}
    except ValueError:
        raise Missing("NAME=X of each goal expected") from None
    studies = sorted(folder.glob("*/runs.jsonl"),
                     key=lambda p: (p.parent.name != "uniform", p.parent.name))
    if not studies:
        raise Missing(f"{folder}: no folders of tools/study in it")
    figure, axes = new(3.4 * len(exact) + 0.4, 4.2, len(exact))
    for k, path in enumerate(studies):
        runs = load_done(path).values()
        for panel, (name, value) in zip(axes[0], exact.items()):
            points = sorted(
                (r["costs"][0]["all"], abs(g["value"] / value - 1.0))
                for r in runs for g in r.get("goals", [])
                if g["goal"] == name and g["value"] is not None
                and r["choice"].get("GOAL_TARGET", ":").split(":")[0]
                in ("", name))
            if points:
                panel.loglog(*zip(*points), marker="osD^"[k % 4], ms=5,
                             color=COLOURS[k % 6], label=path.parent.name)
            panel.set_title(name)
            panel.set_xlabel("CPU time, all passes, s")
            panel.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            panel.xaxis.set_major_formatter("{x:g}")
            panel.xaxis.set_minor_formatter(NullFormatter())
    axes[0, 0].set_ylabel("true error, relative")
    legend_below(axes[0, len(exact) // 2])
    return figure
