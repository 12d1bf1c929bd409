"""Decks and tables of protis for the tools: cards changed, JOB.dat read."""
import hashlib
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "python"))
from protis import compared, read_blocks  # noqa: E402, F401

CARDS = {"METHOD": ("SOLVER", "METHOD"), "TOL": ("SOLVER", "TOL"),
         "FORM": ("QUASISTATIC", "FORM"),
         "INTEGRATOR": ("VISCO", "INTEGRATOR"), "THETA": ("VISCO", "THETA"),
         "TARGET": ("ACCURACY", "TARGET")}
FILES = ("MESH", "INCLUDE", "CONDENSED PROBLEM", "TEMPERATURE",
         "INITIAL CONDITIONS")


def fail(text):
    """End with exit code 2 and a message that begins with the name of the
    tool."""
    print(f"{sys.argv[0].rsplit('/', 1)[-1]}: {text}", file=sys.stderr)
    sys.exit(2)


def default_program():
    """$PROTIS, else that of the sources, else protis on the PATH."""
    built = pathlib.Path(__file__).resolve().parent.parent / "build/release/protis"
    found = str(built) if built.exists() else shutil.which("protis")
    return os.environ.get("PROTIS", found or str(built))


# ---- the deck --------------------------------------------------------------

def card_name(line):
    if not line.startswith("*") or line.startswith("**"):
        return None
    return line[1:].split(",")[0].strip().upper()


def parameters(lines):
    """Names that *PARAMETER defines."""
    names, inside = set(), False
    for line in lines:
        name = card_name(line)
        if name is not None:
            inside = name == "PARAMETER"
        elif inside and "=" in line and not line.startswith("**"):
            names.add(line.split("=")[0].strip())
    return names


VALUE = r'(?:"[^"]*"|[^,"])*'


def value_of(line, name):
    """Value of a parameter of a card without its quotes; None: it has none."""
    found = re.search(rf",\s*{name}\s*=\s*({VALUE})", line, re.IGNORECASE)
    return found and found[1].strip().strip('"')


def set_parameter(line, name, value):
    """A card line with NAME=value instead of what it had."""
    pattern = re.compile(rf",\s*{name}\s*={VALUE}", re.IGNORECASE)
    return pattern.sub("", line.rstrip(",")) + f", {name}={value}"


def set_card(lines, card, name, value):
    """Set it on every such card; a *SOLVER or *ACCURACY that is missing in the
    first step is put there: later steps have those of the step before."""
    out, found = [], False
    for line in lines:
        if card_name(line) == card:
            line, found = set_parameter(line, name, value), True
        elif card_name(line) == "END STEP" and not found and card in (
                "SOLVER", "ACCURACY"):
            out.append(f"*{card}, {name}={value}")
            found = True
        out.append(line)
    if not found:
        fail(f"the deck has no *{card} that {name}={value} could be set of")
    return out


def set_goal(lines, value):
    """X or NAME:X: TARGET=X of every *GOAL or of that name."""
    name, _, target = value.rpartition(":")
    goals = [i for i, line in enumerate(lines) if card_name(line) == "GOAL"
             and (not name or compared(value_of(line, "NAME") or "")
                  == compared(name))]
    if not goals:
        fail(f"the deck has no *GOAL {name}")
    return [set_parameter(line, "TARGET", target) if i in goals else line
            for i, line in enumerate(lines)]


def set_dt(lines, value):
    out, after, found = [], False, False
    for line in lines:
        if after and not line.startswith("*"):
            line = ", ".join([value] + line.split(",")[1:])
            found = True
        after = card_name(line) in ("QUASISTATIC", "VISCO")
        out.append(line)
    if not found:
        fail("the deck has no *QUASISTATIC or *VISCO with increments")
    return out


def absolute_files(lines, folder):
    """Files named by cards, found from anywhere."""
    out = []
    for line in lines:
        for name in ("FILE", "INPUT") if card_name(line) in FILES else ():
            file = value_of(line, name)
            if file:
                line = set_parameter(line, name,
                                     f'"{(folder / file).resolve()}"')
        out.append(line)
    return out


COMMENT = re.compile(r'\s*\*\*(?=(?:[^"]*"[^"]*")*[^"]*$).*')


def joined(lines):
    """Cards and data lines; a card that ends in a comma goes on in the next
    line."""
    out = []
    for line in map(str.strip, lines):
        if not line or line.startswith("**"):
            continue
        if out and card_name(out[-1]) and out[-1].endswith(","):
            out[-1] += " " + line
        else:
            out.append(line)
        if card_name(out[-1]):
            out[-1] = COMMENT.sub("", out[-1])
    return out


def read_deck(path, within=()):
    """Lines of a deck, what it includes in their place, files named from
    anywhere."""
    path = path.resolve()
    if path in within or not path.is_file():
        fail(f"{path}: " + ("includes itself" if path in within
                            else "no such file"))
    out = []
    lines = joined(path.read_text(encoding="utf-8-sig").splitlines())
    for line in absolute_files(lines, path.parent):
        if card_name(line) == "INCLUDE":
            name = value_of(line, "INPUT")
            if not name:
                fail(f"{path}: {line}: no INPUT=")
            out += read_deck(pathlib.Path(name), within + (path,))
        else:
            out.append(line)
    return out


def deck_of(job):
    """The deck of JOB or JOB.inp."""
    deck = job if job.is_file() else job.parent / (job.name + ".inp")
    if not deck.is_file():
        fail(f"{job}: no such deck")
    return deck


# ---- tables of JOB.dat -------------------------------------------------------

def last_block(file, wanted):
    """The last table of that name, as read_blocks gives it."""
    found = None
    for block in read_blocks(file):
        if block["table"] == wanted:
            found = block
    if found is None:
        fail(f"{file} has no table {wanted}: ask for it with *PRINT")
    return found


def read_table(file, wanted):
    """Columns of the last table of that name: {name: [values]}."""
    block = last_block(file, wanted)
    return {c: [r[i] for r in block["rows"]]
            for i, c in enumerate(block["names"])}


def column(file, table, name):
    """(abscissa, values) of a column; abscissa None for one record."""
    data = read_table(file, table)
    if name not in data:
        fail(f"table {table} of {file} has no column {name}; it has "
             f"{', '.join(data)}")
    values = [float(v) for v in data[name]]
    if table != "CONTACT":
        return None, values[-1:]
    pairs = sorted(zip((float(v) for v in data["x"]), values))
    return [p[0] for p in pairs], [p[1] for p in pairs]


def drop_cards(lines, names):
    """The deck without these cards and their data lines."""
    out, dropped = [], False
    for line in lines:
        name = card_name(line)
        if name is not None:
            dropped = name in names
        if not dropped or line.startswith("**"):
            out.append(line)
    return out


def drop_parameter(lines, card, name):
    """Every such card without NAME=."""
    pattern = re.compile(rf",\s*{name}\s*(={VALUE})?(?=,|\s*$)",
                         re.IGNORECASE)
    return [pattern.sub("", line) if card_name(line) == card else line
            for line in lines]


def drop_unused(lines, before, errors):
    """*PARAMETER without the names that the program calls unused, and that the
    deck before used more often."""
    def uses(name, deck):
        return len(re.findall(rf"\b{name}\b", "\n".join(deck), re.IGNORECASE))
    names = [n for n in re.findall(
        r"P2042: \*PARAMETER (\w+) is used neither", errors)
        if uses(n, before) > uses(n, lines)]
    out, card = [], None
    for line in lines:
        card = card_name(line) or card
        if card != "PARAMETER" or line.split("=")[0].strip() not in names:
            out.append(line)
    return out


def insert_in_steps(lines, text):
    """A card at the end of every step."""
    out = []
    for line in lines:
        if card_name(line) == "END STEP":
            out.append(text)
        out.append(line)
    return out


# ---- runs ------------------------------------------------------------------

RUNNING = set()


def call(command):
    """Exit code and messages of a program, which ends with this one."""
    with subprocess.Popen(command, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True) as process:
        RUNNING.add(process)
        errors = process.communicate()[1]
        RUNNING.discard(process)
    return process.returncode, errors


def stop(signal_no, _frame):
    """End the runs at hand; finished ones are in runs.jsonl."""
    for process in list(RUNNING):
        process.terminate()
    print("interrupted; the same command goes on from here",
          file=sys.stderr, flush=True)
    os._exit(128 + signal_no)


def program_of(name):
    """Path of a program and checksum of its bytes."""
    path = shutil.which(name) or fail(
        f"{name}: no program; build it with make")
    return path, hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()


def key_of(result, folder, *parts, since=math.inf):
    """Checksum of parts, of this JOB.json and of all files that its run has
    read, of a deck in that folder. None, which no results have: there is no
    JOB.json, or a file is gone or has changed since that time."""
    key = hashlib.sha256(json.dumps(parts).encode())
    try:
        content = result.read_bytes()
        key.update(content)
        for name in json.loads(content)["files"]:
            path = folder / name
            content = path.read_bytes()
            if path.stat().st_ctime > since:
                return None
            key.update(name.encode() + hashlib.sha256(content).digest())
    except (OSError, ValueError, KeyError):
        return None
    return key.hexdigest()[:16]


def is_done(entry, key):
    """The results in a folder, whose last line is entry, are those of key; a
    run that a signal ended (-9, 137; 143 with its files whole) is not done."""
    return (entry is not None and key is not None and entry["key"] == key
            and 0 <= entry["exit"] < 128)


def load_done(file):
    """The last line of each folder, whose results it tells."""
    done = {}
    if file.exists():
        text = file.read_text(encoding="utf-8")
        if text and not text.endswith("\n"):
            with open(file, "a", encoding="utf-8") as out:
                out.write("\n")
        for line in text.splitlines():
            try:
                entry = json.loads(line)
                done[entry["folder"]] = entry
            except (json.JSONDecodeError, KeyError):
                continue  # the line a kill cut short
    return done
