"""Pressure, shear and status of each contact, in its own plane or line."""
import textwrap

import matplotlib.tri
import numpy as np
from matplotlib import collections

from . import BLUE, GREY, RED, empty, legend_below, plain
from .body import (COLOURS, MAP, MARKS, boundary, colour_bar, comma, line_of,
                   marks, meaning, norm_of)
from .results import Missing


def counts(contact):
    """What its nodes do, in words."""
    return ", ".join(f"{(contact.status == k).sum()} {meaning(contact, k)}"
                     for k in COLOURS if (contact.status == k).any())


def summary(contact):
    """A line of figures for the terminal."""
    return (f"{contact.name}: largest pressure {contact.pressure.max():.4g}, "
            f"shear {np.abs(contact.slides).max():.4g} {contact.unit}".rstrip()
            + "; " + counts(contact))


# ---- two dimensions: along a line --------------------------------------

def places(job, contact, abscissa):
    """(name of the abscissa, [order of nodes], [their places]) of each part."""
    line = contact.points
    spans = np.ptp(line, axis=0)
    if abscissa is None:
        axis = int(np.argmax(spans))
        if len(contact.faces) and spans[1 - axis] > 0.2 * spans[axis]:
            abscissa = "s"
    else:
        if abscissa not in (*job.axes, "s"):
            raise Missing(f"no coordinate {abscissa}: there are "
                          f"{', '.join(job.axes)}, and s along the line")
        axis = job.axes.index(abscissa) if abscissa != "s" else 0
    if abscissa == "s":
        parts = line_of(contact, line)
        gone = [np.r_[0, np.cumsum(np.linalg.norm(np.diff(line[p], axis=0),
                                                  axis=1))] for p in parts]
        return "length along the contact", parts, gone
    order = np.argsort(line[:, axis], kind="stable")
    return job.axes[axis], [order], [line[order, axis]]


def draw_line(axes, job, contact, abscissa=None):
    """Pressure, shear, limit and status along a contact line."""
    name, parts, along = places(job, contact, abscissa)
    shorn = np.any(contact.slides != 0)
    first = True
    for part, s in zip(parts, along):
        def label(text, shown=first):
            return text if shown else None
        if np.any(contact.limit > 0):
            for sign in (1, -1):
                axes.plot(s, sign * contact.limit[part], color=GREY, lw=1,
                          ls="--", label=label("± limit") if sign > 0 else None)
        axes.plot(s, contact.pressure[part], color=BLUE,
                  label=label("pressure"))
        if shorn:
            axes.plot(s, contact.slides[part], color=RED,
                      label=label("shear traction"))
        first = False
        for k in COLOURS:
            mine = contact.status[part] == k
            size = np.clip(200 / max(len(part), 1), 1.5, 4.5)
            axes.plot(s[mine], contact.pressure[part][mine], MARKS[k], ms=size,
                      color=COLOURS[k], mec="#222222", mew=0.4,
                      label=label(meaning(contact, k)) if mine.any() else None)
    axes.set_xlabel(name + comma(job.length))
    axes.set_ylabel("traction on the body" + comma(contact.unit))
    axes.axhline(0, color="#444444", lw=0.8)


# ---- three dimensions: in the plane ------------------------------------

def plane(contact):
    """Rows e1, e2 of the plane of a contact, and their names."""
    normal = contact.normal.mean(axis=0)
    normal /= np.linalg.norm(normal)
    k = int(np.argmax(np.abs(normal)))
    if abs(normal[k]) > 0.99:
        kept = [i for i in range(3) if i != k]
        return np.eye(3)[kept], ["xyz"[i] for i in kept]
    level = np.cross([0.0, 0.0, 1.0], normal)
    level /= np.linalg.norm(level)
    return np.array([level, np.cross(normal, level)]), ["level", "up the slope"]


def flattened(contact):
    """Places and shear in the plane of a contact, its faces and the names of
    the axes. A contact that goes round an axis is unrolled, without the faces
    where it is cut open."""
    normals = contact.normal
    axis = np.linalg.svd(normals.T @ normals)[2][2]
    if np.linalg.norm(normals.mean(axis=0)) > 0.7 or (
            np.abs(normals @ axis).max() > 0.2):
        basis, names = plane(contact)
        return (contact.points @ basis.T, contact.shear @ basis.T,
                contact.faces, names)
    axis *= np.sign(axis[np.argmax(np.abs(axis))])
    off = contact.points - contact.points.mean(axis=0)
    first = np.eye(3)[np.argmin(np.abs(axis))]
    first -= axis * (first @ axis)
    first /= np.linalg.norm(first)
    second = np.cross(axis, first)
    angle = np.arctan2(off @ second, off @ first)
    radius = np.hypot(off @ second, off @ first).mean()
    along = (np.cos(angle)[:, None] * second - np.sin(angle)[:, None] * first)
    flat = np.column_stack([radius * angle, contact.points @ axis])
    shear = np.column_stack([np.sum(contact.shear * along, axis=1),
                             contact.shear @ axis])
    whole = np.ptp(angle[contact.faces], axis=1) < np.pi if len(
        contact.faces) else slice(None)
    return flat, shear, contact.faces[whole], [
        "arc, unrolled", "along the axis"]


def spacing_of(flat):
    """Distance that points in a plane have from each other, by and large."""
    spans = np.ptp(flat, axis=0)
    return np.sqrt(max(np.prod(spans), 1e-300) / len(flat)) or 1.0


def draw_plane(figure, axes, job, contact, unit):
    """Pressure as colour, shear as arrows, status as marks, seen along the
    normal."""
    flat, shear, faces, names = flattened(contact)
    gap = spacing_of(flat)
    norm, _ = norm_of(contact.pressure, False)
    if len(contact.group) and names[0][:3] != "arc":
        edges = boundary(contact.group)[0]
        axes.add_collection(collections.LineCollection(
            (job.points @ plane(contact)[0].T)[edges], colors="#444444", lw=1,
            zorder=3))
    if len(faces):
        mesh = matplotlib.tri.Triangulation(*flat.T, faces)
        axes.tripcolor(mesh, contact.pressure, cmap=MAP, norm=norm,
                       shading="gouraud", rasterized=True)
        axes.triplot(mesh, color="#20304055", lw=0.3)
    else:
        axes.scatter(*flat.T, c=contact.pressure, cmap=MAP, norm=norm, s=90)
    most = np.abs(contact.slides).max()
    if most > 0:
        arrows = shear * (2 * gap / most)
        axes.quiver(*flat.T, *arrows.T, color=RED, angles="xy", zorder=6,
                    scale_units="xy", scale=1, width=0.004)
        axes.update_datalim(flat + arrows)
        axes.plot([], [], color=RED, marker=">", markevery=[-1], ms=5,
                  label=f"shear ≤ {most:.4g} {contact.unit}")
    marks(axes, contact, flat, True, np.clip(110 / np.sqrt(len(flat)), 1, 4))
    axes.set_aspect("equal")
    axes.grid(False)
    axes.margins(0.08)
    colour_bar(figure, axes, norm, MAP, "pressure" + comma(contact.unit))
    for name, label in zip(names, (axes.set_xlabel, axes.set_ylabel)):
        label(name + comma(unit))


def draw(job, title=None, abscissa=None, only=None):
    """A figure with a panel for each contact. only: the number of one, from
    1."""
    contacts = list(job.contacts)
    if not contacts:
        raise Missing(f"{job.name} has no contact")
    if only is not None:
        if not 0 < only <= len(contacts):
            raise Missing(f"{job.name} has no contact {only}; it has "
                          f"{len(contacts)}")
        contacts = [contacts[only - 1]]
    solid = job.dimension == 3
    wide = min(len(contacts), 2 if solid else 3)
    high = -(-len(contacts) // wide)
    figure = empty((5.2 if solid else 4.6) * wide + 1.4, 4.4 * high + 0.4)
    axes = figure.subplots(high, wide, squeeze=False)
    for panel, contact in zip(axes.flat, contacts):
        if solid:
            draw_plane(figure, panel, job, contact, job.length)
        else:
            draw_line(panel, job, contact, abscissa)
        panel.set_title(plain(f"{contact.name}: {counts(contact)}"))
        legend_below(panel)
    for panel in axes.flat[len(contacts):]:
        panel.axis("off")
    if title:
        figure.suptitle(textwrap.fill(plain(title), 12 * wide + 40),
                        fontsize=12)
    return figure, contacts
