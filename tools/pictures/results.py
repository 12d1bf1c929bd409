"""What a run has left: JOB.h5, JOB.dat and JOB.json behind one object."""
import collections
import functools
import json
import pathlib
import re
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent
                       / "python"))
import protis  # noqa: E402

Block = collections.namedtuple(
    "Block", "step increment time table columns units")
Block.__doc__ = """A table of JOB.dat at one time: columns and units by name;
numbers as arrays, words as lists of str."""

Contact = collections.namedtuple(
    "Contact", "name points node group faces normal gap pressure shear limit "
    "status slides unit")
Contact.__doc__ = """The nodes of a contact at the end of the run:
name, points  of *CONTACT; [n, 3] places before loading
node, group   [n] ids in the mesh; [m, 2 or 3] all its faces by such ids
faces         [m, 2 or 3] those of its own nodes alone, as places in node
normal, gap   [n, 3] outward; [n] left open
pressure, shear, limit   [n]; [n, 3], of the obstacle on the body; [n] of shear
status        [n] 0 open, 1 slip, 2 stick
slides        [n] 2-D: shear along the tangent with its sign; 3-D: its size
unit          of the tractions"""

# Components of a symmetric tensor, of plane and solid and of round bodies.
PLACES = ({"xx": 0, "xy": 1, "zx": 2, "yy": 3, "yz": 4, "zz": 5},
          {"rr": 0, "rz": 1, "zz": 3, "tt": 5})
STATUS = ("open", "slip", "stick")


class Missing(Exception):
    """What the caller wants is not in the results: the message says why."""


def read_blocks(path):
    """[Block], all tables of a JOB.dat."""
    found = []
    for b in protis.read_blocks(path):
        columns = {}
        for i, name in enumerate(b["names"]):
            words = [row[i] for row in b["rows"]]
            columns[name] = (words if name in protis.WORDS
                             else np.array(words, float))
        found.append(Block(b["step"], b["increment"], b["time"], b["table"],
                           columns, dict(zip(b["names"], b["units"]))))
    return found


def cards(deck, *names):
    """Of each such card of a deck: {parameter: value}, names in capitals."""
    found = []
    for line in re.sub(r",\s*\n", ", ", deck).splitlines():
        words = re.findall(r'(?:"[^"]*"|[^,"])+', line)
        if words and words[0].strip().upper()[1:] in names:
            found.append({k.strip().upper(): v.strip(' "') for k, _, v in
                          (w.partition("=") for w in words[1:])})
    return found


class Results:
    """Results of a job: JOB, or any file JOB.suffix of it. at: time of the
    fields, the last if None."""

    def __init__(self, path, at=None):
        path = pathlib.Path(path)
        if path.suffix in (".h5", ".dat", ".json", ".lst", ".sta", ".xdmf",
                           ".inp"):
            path = path.with_suffix("")
        self.base, self.name, self.at = path, path.name, at
        if not any(self.file(s).is_file() for s in ("json", "dat", "h5")):
            raise Missing(f"{path}: no results of a run: neither "
                          f"{self.name}.json nor .dat nor .h5" + (
                              f"; {self.file('lst')} says why"
                              if self.file("lst").is_file() else ""))

    def file(self, suffix):
        return self.base.with_name(f"{self.name}.{suffix}")

    def text(self, suffix):
        """The text of JOB.suffix, "" if there is none."""
        file = self.file(suffix)
        return file.read_text(encoding="utf-8") if file.is_file() else ""

    @functools.cached_property
    def json(self):
        try:
            return json.loads(self.text("json") or "{}")
        except ValueError as error:
            raise Missing(f"{self.file('json')}: {error}") from error

    @functools.cached_property
    def title(self):
        return self.json.get("title") or self.name

    @functools.cached_property
    def h5(self):
        if not self.file("h5").is_file():
            raise Missing(f"{self.name}: no {self.name}.h5: the deck says "
                          "*OUTPUT, HDF5=NO")
        try:
            return h5py.File(self.file("h5"), "r")
        except OSError as error:
            raise Missing(f"{self.file('h5')}: {error}") from error

    @functools.cached_property
    def deck(self):
        """The deck as the program has understood it."""
        try:
            return self.h5["deck"][()][0].decode()
        except (Missing, KeyError):
            text = self.text("lst").partition("DECK\n----\n")[2]
            return re.split(r"\n[A-Z]+\n-+\n", text)[0]

    # ---- tables ----

    @functools.cached_property
    def blocks(self):
        if not self.file("dat").is_file():
            raise Missing(f"{self.name}: no {self.name}.dat")
        return read_blocks(self.file("dat"))

    def tables(self, name):
        """All blocks of a table."""
        found = [b for b in self.blocks if b.table == name]
        if not found:
            raise Missing(f"{self.file('dat')} has no table {name}: ask for it "
                          "with *PRINT")
        return found

    def table(self, name, which=-1):
        """{column: values} of the last block of a table, or another."""
        return self.tables(name)[which].columns

    def over_time(self, table, *names, row=0):
        """time, then the columns of a row of each block of a table."""
        blocks = self.tables(table)
        for name in names:
            if name not in blocks[0].columns:
                raise Missing(f"table {table} of {self.name}.dat has no column "
                              f"{name}; it has {', '.join(blocks[0].columns)}")
        time = np.array([b.time for b in blocks])
        return [time] + [np.array([b.columns[n][row] for b in blocks])
                         for n in names]

    # ---- fields ----

    @functools.cached_property
    def axes(self):
        """Names of the coordinates, of JOB.h5 or of the last CONTACT table."""
        if self.file("h5").is_file():
            if "strain_rr" in self.h5["fields"]:
                return "rz"
            return "xyz"[:int(self.h5.attrs["dimension"])]
        table = self.table("CONTACT")
        return "".join(a for a in "rxyz" if a in table)

    @property
    def dimension(self):
        return len(self.axes)

    @functools.cached_property
    def points(self):
        return self.h5["mesh/nodes"][...]

    @functools.cached_property
    def elements(self):
        return self.h5["mesh/elements"][...]

    @functools.cached_property
    def record(self):
        """Name of the record that is shown."""
        time = self.h5["fields/time"][...]
        reached = np.flatnonzero(~np.isnan(time))
        if not len(reached):
            raise Missing(f"{self.name}.h5: no increment was finished")
        last = reached[-1]
        if self.at is not None:
            last = reached[np.argmin(np.abs(time[reached] - self.at))]
        return f"{last + 1:05d}"

    @functools.cached_property
    def time(self):
        return float(self.h5["fields/time"][int(self.record) - 1])

    def has(self, name, group="fields"):
        return group in self.h5 and name in self.h5[group]

    def field(self, name, group="fields"):
        """Values of a field; a component of the tensor of stresses by the name
        that it has in the tables."""
        if self.has(name, group):
            return self.h5[group][name][self.record][...]
        tensor, _, part = name.partition("_")
        places = PLACES["rz" in self.axes]
        if part in places and self.has(tensor, group):
            return self.field(tensor, group)[:, places[part]]
        raise Missing(f"{self.name}.h5 has no field {name}; it has "
                      f"{', '.join(self.h5.get(group, {}))}")

    def unit(self, name, group="fields"):
        """Unit of a field as text, "" for none."""
        if not self.has(name, group):
            name = name.partition("_")[0]
        return unit_text(self.h5[group][name].attrs.get("unit", b"-"))

    @functools.cached_property
    def length(self):
        """Unit of length."""
        if self.file("h5").is_file():
            return self.unit("u")
        return unit_text(self.tables("CONTACT")[-1].units["gap"])

    @functools.cached_property
    def contacts(self):
        """[Contact] in the order of the deck, from JOB.h5 if it is there, else
        from the last CONTACT table of JOB.dat, without node, group, faces, and
        with one normal for all nodes of a contact."""
        if self.file("h5").is_file():
            return self.contacts_of_fields() if "contact" in self.h5 else []
        return self.contacts_of_table()

    def contacts_of_fields(self):
        def field(name):
            return self.field(name, "contact")

        normal, force, area = field("normal"), field("force"), field("area")
        flat = self.dimension == 2
        slides = field("traction_t") if flat else np.hypot(
            field("traction_t1"), field("traction_t2"))
        limit = np.zeros(len(area))
        if self.has("limit", "contact"):
            limit = field("limit") / np.where(area > 0, area, 1)
        shear = shears(force, normal, slides)
        node = self.h5["contact/node"][...]
        known = ~np.isnan(field("status"))  # supports hold the others
        numbers = self.h5["contact/contact_no"][...]
        asked = cards(self.deck, "CONTACT", "CONTACT PAIR", "CRACK")
        found = []
        for no in np.unique(numbers[known]):
            mine = (numbers == no) & known
            card = asked[no - 1] if no <= len(asked) else {}
            group, own = self.faces_of(card.get("GROUP"), node[mine])
            found.append(Contact(
                card.get("NAME", f"contact {no}"), self.points[node[mine]],
                node[mine], group, own, normal[mine], field("gap")[mine],
                field("pressure")[mine], shear[mine], limit[mine],
                np.round(field("status")[mine]).astype(int), slides[mine],
                self.unit("pressure", "contact")))
        return found

    def faces_of(self, group, node):
        """Faces of a group, and those of these nodes as places among them."""
        faces = np.empty((0, self.dimension), int)
        listed = self.h5.get(f"mesh/groups/{group}/faces")
        if listed is not None:
            faces = self.h5["mesh/faces"][...][listed[...]]
        place = np.full(len(self.points), -1)
        place[node] = np.arange(len(node))
        return faces, place[faces][(place[faces] >= 0).all(axis=1)]

    def contacts_of_table(self):
        block = self.tables("CONTACT")[-1]
        table = {k: v for k, v in block.columns.items()
                 if not isinstance(v, list)}
        if "pressure" not in table:
            raise Missing(f"table CONTACT of {self.name}.dat has no pressure: "
                          "the job is no body")
        n, flat = len(table["pressure"]), "traction_t" in table
        zero = np.zeros(n)
        points = np.array([table.get(a, zero) for a in self.axes + "?"][:3]).T
        force = np.array([table.get("f_" + a, zero) for a in "xyz"]).T
        slides = table["traction_t"] if flat else np.hypot(
            table["traction_t1"], table["traction_t2"])
        area = np.divide(table["f_n"], table["pressure"], out=zero + 1,
                         where=table["pressure"] > 0)
        status = np.array([STATUS.index(w.lower())
                           for w in block.columns["status"]])
        names = block.columns.get("contact", ["contact"] * n)
        numbers = table.get("contact_no", np.ones(n))
        found, none = [], np.empty((0, 2 if flat else 3), int)
        for no in np.unique(numbers):
            mine = numbers == no
            normal = np.zeros((n, 3))
            if not flat:
                normal[mine] = mean_normal(points[mine], force[mine])
            name = names[np.flatnonzero(mine)[0]]
            found.append(Contact(
                name if name != "contact" else f"contact {no:.0f}",
                points[mine], none, none, none, normal[mine],
                table["gap"][mine],
                table["pressure"][mine], shears(force, normal, slides)[mine],
                (table.get("limit", zero) / area)[mine], status[mine],
                slides[mine], unit_text(block.units["pressure"])))
        return found


def unit_text(unit):
    """A unit for a label; "" where the deck has no *UNITS."""
    unit = unit.decode() if isinstance(unit, bytes) else str(unit)
    if unit == "-" or re.search(r"length|force|time", unit):
        return ""
    return unit.replace("^2", "²").replace("*", " ")


def shears(force, normal, slides):
    """Tractions of friction [n, 3]: of the size that the traction columns have,
    in the direction of the force across the normal. That force alone would not
    do: at a node between two obstacles it holds the other's normal force."""
    across = force - np.sum(force * normal, axis=1)[:, None] * normal
    length = np.linalg.norm(across, axis=1)
    return across * (np.abs(slides) / np.where(length > 0, length, 1))[:, None]


def mean_normal(points, force):
    """The normal of the plane next to the points, against the forces."""
    off = points - points.mean(axis=0)
    normal = np.linalg.svd(off.T @ off)[2][2]
    return -normal if np.sum(force @ normal) > 0 else normal
