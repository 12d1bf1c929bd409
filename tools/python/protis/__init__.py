"""Run decks of Protis and read their results.

    import protis
    job = protis.run("deck.inp", MU=0.3)
    contact = job.table("CONTACT", last=True)
    contact["pressure"], contact.units["pressure"]     # numpy array, "N/mm^2"
    contact.to_pandas()                                # where pandas is there

Keywords in capitals or not are *PARAMETER names of the deck. The results go to
a folder that lives as long as the job, or to out=FOLDER. What protis refuses
(exit code 2 and above) becomes protis.Error with its message; exit code 1 (an
increment missed its tolerance) is a warning.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import warnings
import weakref

__all__ = ["Error", "Job", "Table", "run", "read_blocks"]


class Error(RuntimeError):
    """What protis refused: str() is its message, code its exit code."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code


# ---- tables ------------------------------------------------------------------

NAMES = ("contact", "crack", "goal", "group")  # columns of names of the deck
WORDS = (*NAMES, "status", "unit", "verdict", "zone")  # columns without numbers
HEADING = re.compile(r"# step (\d+) increment (\d+) time (\S+) table (\S+)"
                     r"(?: group (.*))?$")


def words_of(line):
    """Its words between blanks: to Python others than blanks part words."""
    return re.findall(r"[^ \t\r\n]+", line)


def read_blocks(path):
    """The blocks of a JOB.dat one after another: a dict with step, increment,
    time, table, group ("" if none), names, units, and rows (lists of words)."""
    block, wrong = None, 0
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        for number, line in enumerate(file, 1):
            if wrong:
                raise Error(4, f"{path}:{wrong}: the values of the row are not "
                            "as many as the columns")
            if not line.endswith("\n"):
                break  # a killed run
            found = HEADING.match(line) if line[0] == "#" else None
            if found:
                if block:
                    yield block
                block = {"step": int(found[1]), "increment": int(found[2]),
                         "time": float(found[3]), "table": found[4],
                         "group": found[5] or "", "names": None, "rows": []}
            elif block and block["names"] is None and line[0] == "#":
                heads = [w.partition("[") for w in words_of(line[1:])]
                block["names"] = [h[0] for h in heads]
                block["units"] = [h[2].rstrip("]") for h in heads]
            elif block and line.strip():
                row = words_of(line)
                if len(row) == len(block["names"] or ()):
                    block["rows"].append(row)
                else:
                    wrong = number
    if block and block["names"] is not None:
        yield block


def compared(name):
    """A name as decks compare it, with the blanks of a deck or the "_" that
    tables have for them."""
    return re.sub(r"\s", "_", name).upper()


class Table(dict):
    """Columns by name, numpy arrays of one length: numbers as int or float,
    words as str; units[name] is the unit of a column, "-" for none."""

    def __init__(self, name, columns, units):
        super().__init__(columns)
        self.name = name
        self.units = units
        self.names = {n: set(self[n]) for n in NAMES if n in self}

    def __len__(self):
        return len(next(iter(self.values()))) if self.keys() else 0

    def where(self, **wanted):
        """The rows in which these columns have these values; words are compared
        as decks compare names."""
        import numpy
        keep = numpy.ones(len(self), bool)
        for name, value in wanted.items():
            found = self[name]
            if found.dtype.kind == "U":
                value, there = compared(str(value)), self.names.get(name)
                if there and value not in map(compared, there):
                    raise KeyError(f"{self.name} has no {name} {wanted[name]}; "
                                   f"it has {', '.join(sorted(there))}")
                found = numpy.array([compared(v) for v in found], str)
            elif isinstance(value, str):
                raise TypeError(f"{name} of {self.name} has numbers, as "
                                f"{found[:1]}, not {value}")
            keep &= found == value
        kept = Table(self.name, {k: v[keep] for k, v in self.items()},
                     self.units)
        kept.names = self.names
        return kept

    def to_pandas(self):
        """A pandas.DataFrame; its attrs["units"] are the units."""
        import pandas
        frame = pandas.DataFrame(dict(self))
        frame.attrs["units"] = dict(self.units)
        return frame


def as_array(name, values):
    """A column: numbers as they are, their words as whole numbers or numbers,
    "" as NaN; WORDS as what they are."""
    import numpy
    if name in WORDS:
        return numpy.array(values, dtype=str)
    try:
        return numpy.array([int(v) if isinstance(v, str) else v
                            for v in values])
    except ValueError:
        return numpy.array([float(v or "nan") for v in values])


def joined(name, blocks):
    """One table of all blocks; columns that a block lacks are empty there."""
    units = {"step": "-", "increment": "-", "time": "time"}
    if any(b["group"] for b in blocks):
        units["group"] = "-"
    for b in blocks:
        units.update({n: u for n, u in zip(b["names"], b["units"])})
    columns = {n: [] for n in units}
    for b in blocks:
        place = {n: i for i, n in enumerate(b["names"])}
        for n, values in columns.items():
            if n in b:
                values += [str(b[n]) if n == "group" else b[n]] * len(b["rows"])
            elif n in place:
                values += [row[place[n]] for row in b["rows"]]
            else:
                values += [""] * len(b["rows"])
    return Table(name, {n: as_array(n, v) for n, v in columns.items()}, units)


# ---- fields of JOB.h5 --------------------------------------------------------

def parts(name, data):
    """A dataset as columns: vectors have x, y, z, tensors xx, xy, ..."""
    if data.ndim == 1:
        return {name: data}
    ends = ("x", "y", "z") if data.shape[1] == 3 else (
        "xx", "xy", "xz", "yy", "yz", "zz")
    return {f"{name}_{e}": data[:, i] for i, e in enumerate(ends)}


def unit_of(item):
    unit = item.attrs.get("unit", "-")
    return unit.decode() if isinstance(unit, bytes) else str(unit)


def add_record(rows, file, items, fields, record):
    """The values of one record under the numbers and places of its items."""
    for column, data in {**items, **{k: v for name, group in fields.items()
                                     for k, v in parts(name, group[record][...])
                                     .items()}}.items():
        rows.setdefault(column, []).append(data)
    count = len(next(iter(items.values())))
    at = int(record) - 1
    rows.setdefault("total", []).append([int(file["fields/total"][at])] * count)
    rows.setdefault("time", []).append([file["fields/time"][at]] * count)


def table_of_fields(file, name, last):
    """NODES, ELEMENTS, CONTACT of all records, HISTORY, TOTALS of all
    increments; None: there is no such table."""
    import h5py
    import numpy
    units, rows = {}, {}
    if name in ("HISTORY", "TOTALS"):
        groups = {"": file["history"]} if name == "HISTORY" else dict(
            file.get("totals", {}))
        for contact, group in groups.items():
            data = {k: v[...] for k, v in group.items()}
            units.update({k: unit_of(v) for k, v in group.items()})
            if name == "TOTALS":
                data = {"time": file["history/time"][...],
                        "contact": [contact] * len(file["history/time"]),
                        **data}
            for k, v in data.items():
                rows.setdefault(k, []).append(v[-1:] if last else v)
    else:
        where = {"NODES": ("fields", "mesh/node_no", "node_no"),
                 "ELEMENTS": ("fields", "mesh/elem_no", "elem_no"),
                 "CONTACT": ("contact", "contact/node_no", "node_no")}.get(name)
        if where is None or where[1] not in file:
            return None
        numbers = file[where[1]][...]
        items = {where[2]: numbers}
        points = {"NODES": "mesh/nodes", "CONTACT": "contact/points"}.get(name)
        if points:
            items.update(parts("", file[points][...]))
        fields = {k: g for k, g in file[where[0]].items()
                  if isinstance(g, h5py.Group) and len(g)
                  and len(next(iter(g.values()))) == len(numbers)}
        records = sorted({r for g in fields.values() for r in g})
        records = [r for r in records
                   if not numpy.isnan(file["fields/time"][int(r) - 1])]
        for record in records[-1:] if last else records:
            add_record(rows, file, {k.lstrip("_"): v for k, v in items.items()},
                       fields, record)
        for k, g in fields.items():
            for column in parts(k, next(iter(g.values()))[...]):
                units[column] = unit_of(g)
        length = file.attrs.get("length_unit", b"").decode() or "length"
        units.update(dict.fromkeys("xyz" if points else "", length))
        units["time"] = unit_of(file["fields/time"])
    columns = {k: numpy.concatenate(v) for k, v in rows.items()}
    return Table(name, columns, {k: units.get(k, "-") for k in columns})


# ---- jobs ----------------------------------------------------------------------

class Job:
    """The results of a run: Job("out/greco") opens one that is there."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        try:
            text = self.file("json").read_text(encoding="utf-8")
        except OSError as problem:
            raise Error(4, f"{self.file('json')}: no results of a run: "
                           f"{problem.strerror}") from None
        self.info = json.loads(text)

    def file(self, suffix):
        """JOB.suffix"""
        return self.path.with_name(f"{self.path.name}.{suffix}")

    def tables(self):
        """Names of the tables of JOB.dat."""
        dat = self.file("dat")
        return list(dict.fromkeys(b["table"] for b in read_blocks(dat))
                    ) if dat.exists() else []

    def table(self, name, last=False):
        """A table of JOB.dat, or else of the fields of JOB.h5 (CONTACT, TOTALS,
        NODES, ELEMENTS, HISTORY); last: at the last time alone."""
        name = name.upper()
        dat = self.file("dat")
        blocks = [b for b in read_blocks(dat) if b["table"] == name
                  ] if dat.exists() else []
        if last and blocks:
            end = [blocks[-1][k] for k in ("step", "increment", "time")]
            blocks = [b for b in blocks if end == [
                b[k] for k in ("step", "increment", "time")]]
        if blocks:
            return joined(name, blocks)
        if self.file("h5").exists():
            import h5py
            with h5py.File(self.file("h5"), "r") as file:
                found = table_of_fields(file, name, last)
            if found is not None:
                return found
        raise KeyError(f"{dat} has no table {name}; it has "
                       f"{', '.join(self.tables()) or 'none'}; *PRINT of the "
                       "deck requests others")


def find_program():
    """$PROTIS, protis on the PATH, or the one built from these sources."""
    built = pathlib.Path(__file__).resolve().parents[3] / "build/release/protis"
    program = os.environ.get("PROTIS") or shutil.which("protis") or (
        str(built) if built.exists() else None)
    if program is None:
        raise FileNotFoundError("no program protis: put it on the PATH or its "
                                "name into the variable PROTIS")
    return program


def message_of(errors, code):
    """The lines of stderr without those that only warn."""
    text = errors.strip()
    first = re.search(r"^.*\berror\b.*$", text, re.MULTILINE)
    return text[first.start():] if first else text or f"exit code {code}"


def run(deck, out=None, options=(), program=None, **parameters):
    """Run a deck with these values of its *PARAMETERs; options are further
    words of the command line. The answer is the Job."""
    deck = pathlib.Path(deck)
    folder = pathlib.Path(out or tempfile.mkdtemp(prefix="protis_"))
    folder.mkdir(parents=True, exist_ok=True)
    words = [f"-D{k}={float(v)!r}" if isinstance(v, float) else f"-D{k}={v}"
             for k, v in parameters.items()]
    done = subprocess.run(
        [program or find_program(), str(deck), "-o", str(folder), "--quiet",
         *words, *options], stdin=subprocess.DEVNULL, capture_output=True,
        text=True, errors="replace", check=False)
    if done.returncode not in (0, 1):
        if out is None:
            shutil.rmtree(folder, ignore_errors=True)
        raise Error(done.returncode, message_of(done.stderr, done.returncode))
    if done.returncode == 1:
        warnings.warn(message_of(done.stderr, 1), stacklevel=2)
    job = Job(folder / deck.name.removesuffix(".inp"))
    if out is None:
        weakref.finalize(job, shutil.rmtree, folder, ignore_errors=True)
    return job
