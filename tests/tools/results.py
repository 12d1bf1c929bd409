#!/usr/bin/python3
"""Results for other programs: tools/compare, reference, batch, study and the
Python package. Runs in the folder of the sources; PROTIS: the program. Needs
python3-numpy and python3-h5py; pandas is looked at where it is there."""
import contextlib
import csv
import importlib.util
import io
import json
import os
import pathlib
import re
import runpy
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, "tools/python")
sys.path.insert(1, "tools")
import deck_tools  # noqa: E402
import protis  # noqa: E402

PROGRAM = os.path.abspath(os.environ.get("PROTIS", "build/release/protis"))
os.environ["PROTIS"] = PROGRAM
DECK = pathlib.Path("input/greco/greco.inp")
GOALS = "input/hertz_line/hertz_goals.inp"
SMALL = ["-DN=4", "-DMU=0.5"]


def tool(name, *words):
    """Exit code and what a tool says, in this process: numpy is loaded."""
    said, code, argv = io.StringIO(), 0, sys.argv
    sys.argv = [f"tools/{name}", *map(str, words)]
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            runpy.run_path(sys.argv[0], run_name="__main__")
    except SystemExit as end:
        code = end.code or 0
        if isinstance(code, str):
            code, said = 1, io.StringIO(said.getvalue() + end.code)
    finally:
        sys.argv = argv
    return code, said.getvalue()


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.job = protis.run(DECK, None, SMALL)

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    # ---- compare ---------------------------------------------------------

    def test_compare_knows_what_each_column_is(self):
        a, b = self.job, protis.run(DECK, None, [*SMALL, "--threads", "2"])
        for suffix in ("dat", "sta", "json", "h5"):
            code, said = tool("compare", a.file(suffix), b.file(suffix))
            self.assertEqual(code, 0, said)
        # Sentences with seconds or percent of CPU, and digits of rounding.
        for key, old, new, wanted in (
                ("improve_next", "is 5e+11 times more exact",
                 "is 4e+11 times more exact, TOL=BALANCED saves up to 21 % of "
                 "the CPU", 0),
                ("message", "would end after about 3.2 s of CPU",
                 "would end after about 2.9e-5 s of CPU", 0),
                ("message", "lacks 3.2 s of CPU", "needs 3.2 s of CPU", 1)):
            for name, text in (("new", new), ("old", old)):
                (self.dir / f"{name}.json").write_text(
                    json.dumps({"accuracy": {key: text}}))
            code, said = tool("compare", self.dir / "new.json",
                              self.dir / "old.json")
            self.assertEqual(code, wanted, said)
        # Words and counts of a row: changed, and by how much of what.
        changes = [
            ("CONTACT", "f_n", lambda v, s: v + 1e-4 * s, 1),
            ("CONTACT", "f_n", lambda v, s: v + 1e-8 * s, 0),
            ("CONTACT", "node_no", lambda v, s: v + 1000, 1),
            ("CONTACT", "status", lambda v, s: "OPENED", 1),
            ("TOTALS", "stick", lambda v, s: v + 1, 1),
            ("ENERGY", "energy_defect", lambda v, s: 1e-12 * s, 0),
            ("ENERGY", "energy_defect", lambda v, s: 1e-3 * s, 1),
            ("ENERGY", "energy_defect_relative", lambda v, s: 1e-12, 0),
            ("ENERGY", "energy_defect_relative", lambda v, s: 1e-3, 1)]
        scale = {"f_n": abs(a.table("TOTALS")["force_y"]).max(),
                 "energy_defect": a.table("ENERGY")["external_work"].max()}
        for unit in (1e-12, 1e9):  # no tolerance has a dimension
            for table, name, change, wanted in changes:
                for k, file in enumerate(("new.dat", "old.dat")):
                    self.write_dat(a, file, unit, None if k else (
                        table, name, lambda v: change(v, scale.get(name))))
                code, said = tool("compare", self.dir / "new.dat",
                                  self.dir / "old.dat")
                self.assertEqual(code, wanted, f"{name}, {unit}: {said}")
                if wanted:
                    self.assertIn(f"{table}.{name}, " if name != "node_no"
                                  else "missing", said)

    def write_dat(self, job, file, unit, change):
        """The tables with all numbers with a dimension times unit; one value
        changed before that."""
        with open(self.dir / file, "w", encoding="utf-8") as out:
            for b in protis.read_blocks(job.file("dat")):
                out.write(f"# step {b['step']} increment {b['increment']} time "
                          f"{b['time']} table {b['table']}\n# "
                          + " ".join(f"{n}[{u}]" for n, u in
                                     zip(b["names"], b["units"])) + "\n")
                for k, row in enumerate(b["rows"]):
                    for i, (n, u) in enumerate(zip(b["names"], b["units"])):
                        word = row[i]
                        if change and (b["table"], n, 2 if len(
                                b["rows"]) > 2 else 0) == (*change[:2], k):
                            word = change[2](float(word) if "E" in word
                                             and word[0] in "-0123456789"
                                             else int(word) if word.isdigit()
                                             else word)
                        if re.match(r"-?\d.*[E.]", str(word)):
                            word = f"{float(word) * (unit if u != '-' else 1):.16E}"
                        out.write(f" {word}")
                    out.write("\n")
                out.write("\n\n")

    def test_compare_names_what_is_missing(self):
        a = self.job
        lines = a.file("dat").read_text().splitlines(keepends=True)
        (self.dir / "short.dat").write_text("".join(lines[:3] + lines[4:]))
        code, said = tool("compare", self.dir / "short.dat", a.file("dat"))
        self.assertEqual(code, 1)
        self.assertIn("missing in", said)
        self.assertEqual(tool("compare", a.file("dat"), self.dir / "short.dat")
                         [0], 1)
        self.assertEqual(tool("compare", "--part", a.file("dat"),
                              self.dir / "short.dat")[0], 0)
        text = a.file("dat").read_text()
        (self.dir / "short.dat").write_text(
            text[:text.index("# step", text.index("table TOTALS"))])
        code, said = tool("compare", a.file("dat"), self.dir / "short.dat")
        self.assertEqual(code, 1, said)
        self.assertIn("ENERGY.strain_energy: not in", said)
        self.assertEqual(tool("compare", "--part", a.file("dat"),
                              self.dir / "short.dat")[0], 0)
        for words in ((self.dir / "none.dat", a.file("dat")), (
                a.file("lst"), a.file("lst")), (a.file("dat"),), (
                    a.file("dat"), a.file("dat"), "--atol-of", "f_q"), (
                        a.file("dat"), a.file("dat"), "--ignore", "f_q")):
            code, said = tool("compare", *words)
            self.assertEqual(code, 2)
            self.assertIn("f_q" if "f_q" in words else "", said)

    def test_scale_of_a_column_for_all_of_its_kind(self):
        for name, other in (("new", 1.001), ("old", 1.0)):
            (self.dir / f"{name}.dat").write_text(
                "# step 1 increment 1 time 1.0 table NODES\n"
                "# node_no[-] u_x[m] u_y[m] reaction_x[N]\n"
                f"1 1.0E+006 {other}E+000 2.0E+000\n")
        files = [self.dir / "new.dat", self.dir / "old.dat"]
        self.assertEqual(tool("compare", *files)[0], 0)
        self.assertEqual(tool("compare", *files, "--atol-of", "u_y")[0], 1)
        self.assertEqual(tool("compare", *files, "--atol-of", "u_y",
                              "--ignore", "u_y")[0], 0)

    def test_reference_is_red_for_a_broken_value(self):
        shutil.copytree(DECK.parent, self.dir / "greco",
                        ignore=shutil.ignore_patterns("reference"))
        deck = self.dir / "greco" / DECK.name
        deck.write_text(deck.read_text().replace("N = 32", "N = 4"))
        words = ["tools/reference", "-o", str(self.dir / "out"), str(deck)]

        def reference(*more):
            done = subprocess.run([words[0], *more, *words[1:]], text=True,
                                  capture_output=True, check=False)
            return done.returncode, done.stdout + done.stderr
        self.assertEqual(reference()[0], 1)  # there is none yet
        self.assertEqual(reference("--update")[0], 0)
        code, said = reference()
        self.assertEqual(code, 0, said)
        kept = self.dir / "greco/reference/greco.dat"
        self.assertLess(kept.stat().st_size, 10000)
        text = kept.read_text()
        found = re.search(r"(\n\d+ (?:\S+ ){5})(\d)\.", text)
        broken = f"{found[1]}{int(found[2]) ^ 1}."
        kept.write_text(text.replace(found[0], broken, 1))
        code, said = reference()
        self.assertEqual(code, 1)
        self.assertRegex(said, r"CONTACT\.\w+, step 1 increment 5 node_no \d+")
        broken = kept.read_text()
        deck.write_text("*NONSENSE\n")  # the results of the run before are there
        self.assertEqual(reference("--update")[0], 1)
        self.assertEqual(kept.read_text(), broken)

    # ---- batch and study ---------------------------------------------------

    def test_batch_goes_on_after_an_interruption(self):
        decks = []
        for name in ("a", "b", "c"):
            folder = self.dir / name
            folder.mkdir()
            shutil.copy(DECK.with_suffix(".geo"), folder)
            text = DECK.read_text() if name != "c" else "*NONSENSE\n"
            (folder / "job.inp").write_text(text)
            decks.append(str(folder / "job.inp"))
        words = ["batch", *decks, "-o", str(self.dir / "out"), "--", "-DN=4"]
        with subprocess.Popen([f"tools/{words[0]}", *words[1:]], text=True,
                              stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL) as first:
            line = json.loads(first.stdout.readline())
            first.send_signal(signal.SIGTERM)
            first.wait()
        self.assertEqual((line["deck"], line["exit"]), (decks[0], 0))
        self.assertEqual(line["contacts"][0]["contact"], "FOOT")
        self.assertAlmostEqual(line["contacts"][0]["normal"], 2000, places=6)
        self.assertEqual(tool(*words)[0], 1)
        lines = [json.loads(text) for text in
                 (self.dir / "out/batch.jsonl").read_text().splitlines()]
        self.assertEqual([entry["deck"] for entry in lines], decks)
        self.assertEqual([entry["exit"] for entry in lines], [0, 0, 2])
        self.assertIn("NONSENSE", lines[2]["message"])
        self.assertEqual(len({entry["folder"] for entry in lines}), 3)
        code, said = tool(*words)
        self.assertEqual(code, 1)  # what was refused is read again
        self.assertEqual(json.loads(said.splitlines()[0])["deck"], decks[2])
        self.assertIn("1 of 3 runs did not end with 0", said)

    def test_batch_repeats_what_a_signal_ended(self):
        def batch():
            said = tool("batch", DECK, "-o", self.dir, "--", "-DN=4")[1]
            self.assertEqual(json.loads(said.splitlines()[0])["exit"], 0)
        for code in (0, -9, 143):
            batch()
            lines = self.dir / "batch.jsonl"
            lines.write_text(lines.read_text().replace(
                '"exit": 0', f'"exit": {code or -15}'))
        for hand in (False, True):  # of another run in the folder, too
            if hand:
                protis.run(DECK, lines.parent / DECK.stem, N=5)
            batch()

    def test_what_has_changed_is_run_again(self):
        """A deck, back to what it was before too; files of other folders that
        the deck or its mesh names; not what is as in the last run."""
        (self.dir / "deck").mkdir()
        deck, geo = self.dir / "deck/job.inp", self.dir / DECK.stem
        (self.dir / "deck/my, job.geo").write_text(f'Merge "../{geo.name}.geo";\n')
        geo, normal = geo.with_suffix(".geo"), []
        for load, more, runs in (("50.", "", 1), ("50.", "", 0),
                                 ("100.", "", 1), ("50.", "", 1),
                                 ("50.", "// another", 1)):
            geo.write_text(DECK.with_suffix(".geo").read_text() + more)
            deck.write_text(DECK.read_text().replace("greco.geo", '"my, job.geo"')
                            .replace("TOP, P, 50.", f"TOP, P, {load}"))
            done = tool("batch", deck, "-o", self.dir / "b", "--", *SMALL)
            self.assertEqual((done[0], done[1].count("\n")), (0, runs), done)
            total = protis.Job(self.dir / "b/job/job").table("TOTALS")
            self.assertAlmostEqual(total["normal"][0], 40 * float(load), 6)
            code, said = tool("study", deck, "--response", "TOTALS.normal:foot",
                              "--vary", "N=4", "-o", self.dir / "s")
            self.assertEqual((code, said.count("1/1 N=4")), (0, runs), said)
            normal.append(float(re.search(r"^ *4 +(\S+)", said, re.M)[1]))
        np.testing.assert_allclose(normal, [2000, 2000, 4000, 2000, 2000])

    def test_each_deck_has_its_folder_and_its_exit_code(self):
        decks = []
        for folder, name, text in (("d1", "a", "*STEP\n*STATIC\n*END STEP\n"),
                                   ("d2", "a", "*NONSENSE\n"),
                                   ("d1", "a_2", "*STEP\n*STATIC\n"
                                    "*PRINT, CONTACT\n*END STEP\n")):
            (self.dir / folder).mkdir(exist_ok=True)
            (self.dir / folder / "p.lcp").write_text("1\n2.\n-4.\n")
            decks.append(self.dir / folder / f"{name}.inp")
            decks[-1].write_text("*CONDENSED PROBLEM, FILE=p.lcp\n" + text)
        code, said = tool("batch", *decks, "-o", self.dir / "out")
        self.assertEqual(code, 1, said)
        lines = [json.loads(text) for text in (
            self.dir / "out/batch.jsonl").read_text().splitlines()]
        self.assertEqual(len({line["folder"] for line in lines}), 3)
        for words in ([], ["--update"]):
            done = subprocess.run(
                ["tools/reference", *words, "-o", self.dir / "out", *decks],
                capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn("two decks have the name a", done.stderr)

    def test_batch_tells_a_deck_that_is_not_there(self):
        code, said = tool("batch", self.dir / "none.inp", "-o", self.dir)
        self.assertEqual(code, 2, said)

    def test_decks_of_a_study_have_what_is_varied(self):
        lines = ["*STEP", "*SOLVER, METHOD=SOR", "*END STEP", "*STEP",
                 "*VISCO", "1., 2.", "*END STEP"]
        self.assertEqual(  # later steps have the solver of the first
            deck_tools.set_card(lines, "SOLVER", "TOL", "1e-5"),
            [lines[0], lines[1] + ", TOL=1e-5", *lines[2:]])
        self.assertEqual(deck_tools.set_card(lines[3:], "SOLVER", "TOL", "1")
                         [-2:], ["*SOLVER, TOL=1", "*END STEP"])
        goal = ['*GOAL, NAME="A, B", TARGET="1 + 1"']
        self.assertEqual(deck_tools.set_goal(goal, "a, b:5%"),
                         ['*GOAL, NAME="A, B", TARGET=5%'])
        (self.dir / "a.inp").write_text(
            '*STEP\n*VISCO,\n** why\n\nINTEGRATOR=EULER\n\n** dt\n1., 2.\n'
            '*TEMPERATURE, FILE=a b.h5 , X=1 ** of "a"\n')
        self.assertEqual(deck_tools.set_dt(
            deck_tools.read_deck(self.dir / "a.inp"), "0.1"),
            ["*STEP", "*VISCO, INTEGRATOR=EULER", "0.1,  2.",
             f'*TEMPERATURE, X=1, FILE="{self.dir / "a b.h5"}"'])
        for change in ((deck_tools.set_card, "QUASISTATIC", "FORM", "VELOCITY"),
                       (deck_tools.set_goal, "5%"), (deck_tools.set_dt, "1."),
                       (deck_tools.set_goal, "C:5%")):
            with self.assertRaises(SystemExit):  # nothing would change
                change[0](goal * (change[1] == "C:5%"), *change[1:])

    def test_study_tells_errors_of_goals(self):
        """Of the peak of Hertz, with a target of its own: within it."""
        code, said = tool("study", GOALS,
                          "--error", "GOALS", "--reference",
                          "PEAK=2710.98998,SIDE=-0.00123809517", "--vary",
                          "GOAL_TARGET=PEAK:1%", "--vary", "N=4", "-o",
                          self.dir / "goals")
        self.assertEqual(code, 0, said)
        rows = [line.split() for line in
                (self.dir / "goals/study.txt").read_text().splitlines()]
        self.assertEqual([r[2] for r in rows], ["GOAL", "PEAK", "SIDE"])
        self.assertLess(float(rows[1][4]), 0.01)
        self.assertEqual(tool("study", GOALS,
                              "--error", "GOALS", "--reference", "5", "--vary",
                              "N=4", "-o", self.dir / "goals")[0], 2)

    def test_study_tells_what_has_no_answer(self):
        def study(*words):
            return tool("study", DECK, *words, "-o", self.dir / "study")
        for words, said in (
                (("--reference", "0"), "the reference is 0"),
                (("--reference", "nan"), "the reference is nan"),
                (("--reference", "inf"), "the reference is inf")):
            code, text = study("--vary", "N=4", *words)
            self.assertEqual(code, 2, text)
            self.assertIn(said, text)
        for words in (("--reference", "2.5"),
                      ("--response", "TOTALS.force_x")):
            code, text = study("--vary", "MU=0.5,-1", "--vary", "N=4", *words)
            self.assertEqual(code, 1, text)
            rows = [line.split() for line in (
                self.dir / "study/study.txt").read_text().splitlines()]
            self.assertEqual([r[0] for r in rows], ["MU", "0.5", "-1"])
            self.assertIn("exit", rows[0])
            self.assertNotEqual(rows[2][-1], "0")
            self.assertIn("study: no answer for MU=-1", text)

    def test_study_drops_what_it_replaces(self):
        """Of *PARAMETER, and nothing else that is not used."""
        deck = self.dir / "block.inp"
        for more, wanted in (("", 0), ("K = 3", 2)):
            deck.write_text("\n".join(
                line.replace("<DT>", "<H>").replace("DT = 0.2", f"H = 0.2\n{more}")
                for line in deck_tools.read_deck(DECK)))
            code, said = tool("study", deck, "--vary", "DT=1", "--vary", "N=4",
                              "--response", "TOTALS.normal", "-o",
                              self.dir / "study")
            self.assertEqual(code, wanted, said)
            self.assertEqual("PARAMETER K is used neither" in said, bool(more))

    def test_study_tells_a_response(self):
        code, said = tool("study", DECK, "--response", "TOTALS.force_x",
                          "--vary", "MU=0.2,0.8", "--vary", "N=4", "-o",
                          self.dir / "study")
        self.assertEqual(code, 0, said)
        rows = [line.split() for line in
                (self.dir / "study/study.txt").read_text().splitlines()]
        self.assertEqual(rows[0][:3], ["MU", "N", "TOTALS.force_x[N]"])
        for row in rows[1:]:
            job = protis.run(DECK, N=4, MU=row[0])
            self.assertAlmostEqual(float(row[2]), job.table(
                "TOTALS", last=True)["force_x"][0], places=5)
        self.assertGreater((self.dir / "study/study.svg").stat().st_size, 3000)
        self.assertNotEqual(tool("study", DECK, "--response", "TOTALS.nix",
                                 "--vary", "N=4", "-o", self.dir / "s")[0], 0)

    # ---- Python and csv ------------------------------------------------------

    def test_effects_are_switched_off_one_by_one(self):
        """What only they have used of *PARAMETER too; also without contact."""
        deck = self.dir / "block.inp"
        mesh = pathlib.Path("tests/regression/bad/square.msh").resolve()
        body = [f"*MESH, FILE={mesh}", "*MATERIAL, NAME=M", "*ELASTIC",
                "1000., 0.", "*SOLID SECTION, ELSET=BODY, MATERIAL=M"]
        step = ["*STEP", "*STATIC", "*BOUNDARY", "BOTTOM, 1, 2",
                "*DSLOAD", "TOP, P, 1.", "TOP, TX, 0.1", "*END STEP"]
        contact = ["*PARAMETER", "MU = 0.2", "*OBSTACLE, NAME=O, TYPE=CONFORMING",
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O",
                   "*FRICTION, CONTACT=C, LAW=COULOMB", "<MU>"]
        held = ["LEFT, 1" if line.startswith("BOTTOM") else line
                for line in step]
        for lines, rows, last in ((body + contact + held, 4, "-100"),
                                  (body + step, 2, "0")):
            deck.write_text("\n".join(lines))
            code, said = tool("effects", deck, "--repeat", 1, "-o",
                              self.dir / "p")
            table = [row.split() for row in said.splitlines()[2:-1]]
            self.assertEqual((code, len(table)), (0, rows), said)
            self.assertEqual(table[0][-1], last, said)

    def test_tables_have_names_numbers_and_units(self):
        job = protis.run(DECK, MU=0.5, N=4)
        contact = job.table("contact", last=True)
        self.assertEqual(contact.units["pressure"], "N/mm^2")
        self.assertEqual(contact["node_no"].dtype.kind, "i")
        self.assertEqual(set(contact["contact"]), {"FOOT"})
        total = job.table("TOTALS", last=True)
        self.assertAlmostEqual(contact["f_n"].sum(), total["normal"][0], 8)
        for word in ("STICK", "stick"):
            self.assertEqual(len(contact.where(status=word)), total["stick"][0])
        nodes = job.table("NODES")  # no *PRINT: of JOB.h5, five increments
        self.assertEqual(len(nodes) % 5, 0)
        self.assertEqual(nodes.units["u_x"], "mm")
        with self.assertRaisesRegex(TypeError, "node_no of NODES has numbers"):
            nodes.where(node_no="1")
        self.assertEqual(len(job.table("NODES", last=True)), len(nodes) // 5)
        stress = job.table("ELEMENTS", last=True)
        xx, yy, zz, xy = (stress[f"stress_{c}"] for c in
                          ("xx", "yy", "zz", "xy"))
        np.testing.assert_allclose(stress["mises"], np.sqrt(
            ((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) / 2 + 3 * xy**2))
        middle, radius = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
        np.testing.assert_allclose(
            stress["principal_1"], np.maximum(zz, middle + radius), atol=1e-9)
        history = job.table("HISTORY")
        self.assertEqual(list(history["increment"]), [1, 2, 3, 4, 5])
        if importlib.util.find_spec("pandas"):
            frame = contact.to_pandas()
            self.assertEqual(len(frame), len(contact))
            self.assertEqual(frame.attrs["units"]["x"], "mm")

    def test_words_of_tables_end_at_blanks_alone(self):
        """Labels of units and names of contacts hold what Python parts at."""
        for suffix in (".inp", ".geo"):
            shutil.copy(DECK.with_suffix(suffix), self.dir)
        deck = self.dir / DECK.name
        deck.write_text(deck.read_text().replace(
            "LENGTH=mm", "LENGTH=US\u00a0ft \u2003[x]").replace(
                "FOOT", "A\u00a0B\u2003C"), encoding="utf-8")
        contact = protis.run(deck, N=4).table("CONTACT", last=True)
        self.assertEqual(contact.units["gap"], "US\u00a0ft_\u2003_x_")
        self.assertEqual(set(contact["contact"]), {"A\u00a0B\u2003C"})

    def test_times_and_names_are_what_they_are(self):
        """Times are numbers, names are words, which decks compare."""
        for suffix in (".inp", ".geo"):
            shutil.copy(DECK.with_suffix(suffix), self.dir)
        deck = self.dir / DECK.name
        for name, word in (("1 2", "1_2"), ("nan", "nan"),
                           ("Left  Foot", "Left__Foot")):
            deck.write_text(DECK.read_text().replace("FOOT", name).replace(
                "ENERGY, FREQUENCY=0", "ENERGY"))
            job = protis.run(deck, self.dir / "out", SMALL)
            total = job.table("TOTALS")
            times = [b["time"] for b in protis.read_blocks(job.file("dat"))
                     if b["table"] == "TOTALS"]
            self.assertEqual([float(t) for t in total["time"]], times)
            self.assertEqual(len(total.where(time=times[0])), 1)
            self.assertEqual(set(total["contact"]), {word})
            for wanted in (name, word, name.upper()):
                self.assertEqual(len(total.where(contact=wanted)), len(times))
            with self.assertRaisesRegex(KeyError, f"no contact TOE; .*{word}"):
                total.where(contact="TOE")
            file = self.dir / "other.dat"
            file.write_text(job.file("dat").read_text().replace(
                f" {word} ", f" {word.replace('_', '')} "))
            self.assertEqual(tool("compare", file, job.file("dat"))[0],
                             int("_" in word))

    def test_rows_of_other_length_are_an_error(self):
        lines = self.job.file("dat").read_text().splitlines()
        short, file = lines[3].rpartition(" ")[0], self.dir / "a.dat"
        file.write_text("\n".join(lines[:3] + [short] + lines[4:]) + "\n")
        with self.assertRaisesRegex(protis.Error, "a.dat:4: the values"):
            list(protis.read_blocks(file))
        file.write_text("\n".join(lines[:3] + [short]) + "\n")
        self.assertEqual(len(next(protis.read_blocks(file))["rows"]), 1)

    def test_errors_of_the_program_are_exceptions(self):
        with self.assertRaisesRegex(protis.Error, "none.json: no results"):
            protis.Job(self.dir / "none")
        with self.assertRaises(protis.Error) as caught:
            protis.run(DECK, NIX=1)
        self.assertEqual(caught.exception.code, 2)
        self.assertIn("-D NIX is used neither in the deck", str(caught.exception))
        with self.assertRaises(KeyError) as caught:
            protis.run(DECK, N=4).table("REACTIONS")
        self.assertIn("it has CONTACT, TOTALS, ENERGY", str(caught.exception))

    def test_csv_is_read_in_one_line(self):
        job = self.job
        text = subprocess.run([PROGRAM, job.path, "--table", "CONTACT"],
                              capture_output=True, text=True, check=True).stdout
        wanted = job.table("CONTACT")
        rows = list(csv.DictReader(io.StringIO(text)))
        self.assertEqual([float(r["pressure"]) for r in rows],
                         list(wanted["pressure"]))
        data = np.genfromtxt(io.StringIO(text), delimiter=",", names=True,
                             dtype=None, encoding=None)
        np.testing.assert_array_equal(data["u_n"], wanted["u_n"])
        self.assertEqual(list(data["status"]), list(wanted["status"]))
        self.assertEqual(list(data.dtype.names[:5]),
                         ["step", "increment", "time", "contact", "node_no"])
        if importlib.util.find_spec("pandas"):
            import pandas
            frame = pandas.read_csv(io.StringIO(text))
            self.assertEqual(frame["f_n"].sum(), wanted["f_n"].sum())

    def test_example_of_the_package(self):
        table, picture = self.dir / "study.csv", self.dir / "study.png"
        subprocess.run([sys.executable, "tools/python/example.py", table,
                        picture], check=True)
        friction = [float(r["friction"]) for r in
                    csv.DictReader(io.StringIO(table.read_text()))]
        self.assertEqual(len(friction), 5)
        self.assertEqual(friction, sorted(friction))
        self.assertLess(friction[0], 0.2 * 2000)  # mu N
        self.assertGreater(picture.stat().st_size, 3000)


if __name__ == "__main__":
    result = unittest.main(exit=False, argv=["results", *sys.argv[1:]]).result
    bad = len(result.failures) + len(result.errors)
    run = result.testsRun
    print(f"{100 * (run - bad) // max(run, 1)}%: Checks: {run}, "
          f"Failures: {len(result.failures)}, Errors: {len(result.errors)}")
    sys.exit(bad > 0 or run == 0)
