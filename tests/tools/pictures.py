#!/usr/bin/python3
"""Pictures and page of results: contacts are drawn in their own planes from the
traction columns, the page is well-formed and its figures are those of
JOB.json. Runs in the folder of the sources; PROTIS: the program. Needs
python3-matplotlib and python3-h5py."""
import contextlib
import io
import itertools
import json
import math
import os
import pathlib
import re
import runpy
import shlex
import subprocess
import sys
import tempfile
import unittest
import unittest.mock as mock
import xml.etree.ElementTree as tree

sys.path.insert(0, "tools")
import deck_tools
import numpy as np
from pictures import closed, results

# Two blocks under given pressures, dragged: 20 on the wall x = 0, which moves
# along y with mu = 0.4, 10 on the floor z = 0, which moves along -x with
# mu = 0.3. Shear 8 and 3 at every node.
BLOCKS = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 1, 1, 1, 1};
Box(2) = {3, 0, 0, 1, 1, 1};
Mesh.MeshSizeMax = 0.5;
Physical Volume("BODY") = {1, 2};
Physical Surface("LEFT") = Surface In BoundingBox{-0.1, -1, 0, 0.1, 2, 3};
Physical Surface("BOTTOM") = Surface In BoundingBox{2, -1, -0.1, 5, 2, 0.1};
Physical Surface("HELD") = {Surface In BoundingBox{0.9, -1, 0, 1.1, 2, 3},
                            Surface In BoundingBox{2, -1, 0.9, 5, 2, 1.1}};
"""
WALLS = """*HEADING
A floor & a wall <that> drag two blocks
*MESH, FILE=walls.geo
*MATERIAL, NAME=STEEL
*ELASTIC
210.D3, 0.3
*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL, TYPE=C3D4
*OBSTACLE, NAME=FLOOR, TYPE=PLANE
0., 0., 0.
0., 0., 1.
MOVE, -1., 0., 0.
*OBSTACLE, NAME=WALL, TYPE=PLANE
0., 0., 0.
1., 0., 0.
MOVE, 0., 1., 0.
*CONTACT, NAME=BASE, GROUP=BOTTOM, OBSTACLE=FLOOR
*CONTACT, NAME=SIDE, GROUP=LEFT, OBSTACLE=WALL
*FRICTION, CONTACT=BASE, LAW=COULOMB
0.3
*FRICTION, CONTACT=SIDE, LAW=COULOMB
0.4
*CONTACT FORCE, CONTACT=BASE
10.
*CONTACT FORCE, CONTACT=SIDE
20.
*STEP
*QUASISTATIC
0.5, 1.
*BOUNDARY
HELD, 1, 3, 0.
*PRINT, CONTACT, TOTALS
*END STEP
"""
ROOT = pathlib.Path.cwd()
PROGRAM = os.environ.get("PROTIS", str(ROOT / "build/release/protis"))
SPACE = "{http://www.w3.org/1999/xhtml}"


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise AssertionError(
            f"{command}: exit {done.returncode}: {done.stderr}")


def tool(name, *words):
    """What a tool prints, in this process: matplotlib is loaded."""
    said, argv = io.StringIO(), sys.argv
    sys.argv = [f"tools/{name}", *words]
    try:
        with contextlib.redirect_stdout(said):
            runpy.run_path(sys.argv[0], run_name="__main__")
    except SystemExit as end:
        if end.code:
            raise
    finally:
        sys.argv = argv
    return said.getvalue()


class Walls(unittest.TestCase):
    """Each contact in its plane, from JOB.h5 and from JOB.dat alone."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.job = pathlib.Path(cls.folder.name) / "walls"
        cls.job.with_suffix(".inp").write_text(WALLS, encoding="utf-8")
        cls.job.with_suffix(".geo").write_text(BLOCKS, encoding="utf-8")
        run(PROGRAM, f"{cls.job}.inp", "-o", cls.folder.name, "--quiet")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def check(self, job):
        said = tool("plot_contact", f"{job}.dat", f"{job}.svg", "walls", "x")
        tree.parse(f"{job}.svg")
        svg = pathlib.Path(f"{job}.svg").read_text(encoding="utf-8")
        found = re.findall(r"^(.*): largest pressure (\S+), shear ([^ ;]+)",
                           said, re.MULTILINE)
        self.assertEqual([f[1:] for f in found], [("10", "3"), ("20", "8")])
        for name, _, shear in found:
            self.assertIn(f"{name}: ", svg)
            self.assertIn(f"shear ≤ {shear}", svg)
        axes = "".join(re.findall(r"> ?([xyz])</text>", svg))
        self.assertEqual(axes, "xyyz")  # x-y for the floor, y-z for the wall

    def test_each_contact_has_a_panel_in_its_plane(self):
        self.check(self.job)

    def test_body_is_drawn_in_colours_of_its_stresses(self):
        picture = pathlib.Path(f"{self.job}_body.svg")
        tool("plot", "body", str(self.job), str(picture))
        svg = picture.read_text(encoding="utf-8")
        self.assertGreater(len(set(re.findall("fill: #......", svg))), 20)

    def test_table_alone_gives_the_same(self):
        alone = self.job.with_name("alone.dat")
        alone.write_bytes(self.job.with_suffix(".dat").read_bytes())
        self.check(self.job.with_name("alone"))

    def test_shear_is_that_of_the_traction_columns(self):
        found = results.Results(self.job).contacts
        self.assertEqual([c.name for c in found], ["BASE", "SIDE"])
        for contact, shear in zip(found, ([-3, 0, 0], [0, 8, 0])):
            self.assertGreater(len(contact.shear), 8)
            np.testing.assert_allclose(contact.shear, np.tile(
                shear, (len(contact.shear), 1)), atol=1e-6)

    def test_contacts_have_the_names_of_their_cards(self):
        """Pairs too, which here precede the obstacles."""
        text = (ROOT / "input/arch/arch.inp").read_text(encoding="utf-8")
        a, b, c = (text.index(t) for t in (
            "*CONTACT, NAME=RIGHT", "*CONTACT PAIR, NAME=JOINT 1", "*STEP"))
        deck = self.job.with_name("arch.inp")
        deck.write_text((text[:a] + text[b:c] + text[a:b] + text[c:]).replace(
            "arch.geo", f"{ROOT}/input/arch/arch.geo"), encoding="utf-8")
        run(PROGRAM, str(deck), "-o", self.folder.name, "--quiet")
        job = results.Results(deck)
        self.assertEqual(
            [(c.name, len(c.group) > 0) for c in job.contacts],
            [(c["contact"], c["contact"] in ("RIGHT", "LEFT"))
             for c in job.json["contacts"]])

    def test_normal_force_of_a_second_obstacle_is_no_shear(self):
        shear = results.shears(np.array([[214.0, 0, 123], [0, 5, 1]]),
                               np.array([[0.0, 0, -1], [0, 0, -1]]),
                               np.array([0.0, 2]))
        np.testing.assert_allclose(shear, [[0, 0, 0], [0, 2, 0]])


class Page(unittest.TestCase):
    """JOB.html of a job with warnings and an error of the mesh."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        lines = deck_tools.read_deck(
            pathlib.Path("input/hild_triangle/hild_triangle.inp"))
        lines = deck_tools.insert_in_steps(lines, "*ACCURACY, MESH=YES")
        job = pathlib.Path(cls.folder.name) / "hild"
        job.with_suffix(".inp").write_text("\n".join(lines), encoding="utf-8")
        run(PROGRAM, f"{job}.inp", "-o", cls.folder.name, "--quiet")
        cls.page = tool("report", str(job)).strip()
        cls.data = json.loads(job.with_suffix(".json").read_text())

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_figures_are_those_of_the_json(self):
        found = {}
        for e in tree.parse(self.page).iter(SPACE + "data"):
            value = self.data
            for part in e.get("data-json").split("."):
                value = value[int(part) if part.isdigit() else part]
            self.assertEqual(float(e.get("value")), value)
            self.assertTrue(math.isclose(float(e.text), value, rel_tol=6e-4))
            found[e.get("data-json")] = value
        wanted = ["exit.code", "cost.cpu", "accuracy.mesh_error_percent"]
        for part in ("accuracy", "sizes"):
            wanted += [f"{part}.{k}" for k, v in self.data[part].items()
                       if isinstance(v, (int, float))]
        wanted += [f"cost.stages.{i}.cpu" for i, s in enumerate(
            self.data["cost"]["stages"]) if s["calls"]]
        wanted += [f"effects.{i}.expected_cpu_percent"
                   for i, e in enumerate(self.data["effects"])]
        wanted += [f"contacts.{i}.{k}"
                   for i, c in enumerate(self.data["contacts"])
                   for k, v in c.items() if isinstance(v, (int, float))]
        self.assertEqual([k for k in wanted if k not in found], [])

    def test_page_needs_nothing_but_itself(self):
        text = pathlib.Path(self.page).read_text(encoding="utf-8")
        for word in re.findall(r'(?:src|href|action)="([^"]*)"', text):
            self.assertRegex(word, "^(#|data:)")
        self.assertNotIn("<script", text)
        self.assertNotRegex(text, r"url\([^#]")
        ids = re.findall(r'\sid="([^"]*)"', text)
        self.assertEqual(len(ids), len(set(ids)))

    def test_page_shows_deck_warnings_and_reasons(self):
        text = " ".join(tree.parse(self.page).getroot().itertext())
        self.assertGreater(len(self.data["warnings"]), 0)
        for part, key in (("effects", "why"), ("warnings", "text")):
            for entry in self.data[part]:
                self.assertIn(entry[key], text)
        for word in (self.data["title"],
                     self.data["version"], "*SOLID SECTION"):
            self.assertIn(word, text)

    def test_page_has_its_pictures(self):
        svg = "{http://www.w3.org/2000/svg}svg"
        self.assertEqual(len(list(tree.parse(self.page).iter(svg))), 4)


class Tutorial(unittest.TestCase):
    """Its commands run in their order, those of tools/ in this process."""

    def run_lines(self, text):
        for tools, lines in itertools.groupby(
                text.splitlines(), lambda line: line.startswith("tools/")):
            if not tools:
                run("/bin/sh", "-euc", "\n".join(lines))
                continue
            for name, *words in map(shlex.split, lines):
                self.assertTrue(os.access(name, os.X_OK), name)
                tool(name.removeprefix("tools/"), *words)

    def test_every_command_runs(self):
        text = (ROOT / "src/manual/tutorial.md").read_text(encoding="utf-8")
        blocks = re.findall(r"^```(sh|file (\S+))\n(.*?)^```$", text,
                            re.MULTILINE | re.DOTALL)
        with tempfile.TemporaryDirectory() as folder, mock.patch.dict(
                os.environ, PATH=f"{pathlib.Path(PROGRAM).parent}:"
                                 f"{os.environ['PATH']}"):
            os.chdir(folder)
            os.symlink(ROOT / "tools", "tools")
            try:
                for kind, file, lines in blocks:
                    if kind == "sh":
                        self.run_lines(lines)
                    else:
                        pathlib.Path(file).write_text(lines, encoding="utf-8")
                made = {p.name for p in pathlib.Path().rglob("*.*")}
            finally:
                os.chdir(ROOT)
        self.assertLessEqual({"body.png", "foot.png", "force.png", "foot.html",
                              "study.svg"}, made)


class Gallery(unittest.TestCase):
    """Kept pictures: one for each example, small, all in the chapter."""

    def test_each_example_has_its_picture(self):
        kept = ROOT / "src/manual/pictures"
        sizes = {p.name: p.stat().st_size for p in kept.iterdir()}
        self.assertLess(max(sizes.values()), 200_000)
        self.assertLess(sum(sizes.values()), 3_000_000)
        chapter = (ROOT / "src/manual/gallery.md").read_text(encoding="utf-8")
        for folder in (ROOT / "input").iterdir():
            if folder.is_dir():
                self.assertIn(folder.name + ".png", sizes)
                self.assertIn(f"pictures/{folder.name}.png", chapter)


class ClosedForms(unittest.TestCase):
    """The curves of the pictures have the values of input/*/reference.txt."""

    def test_contact(self):
        line, zero = closed.Line(), np.zeros(1)
        pressure, _, stick = closed.spence(line, 0.2, 0.98272, zero + 1e-9)
        self.assertAlmostEqual(stick / 0.36039, 1, delta=3e-3)
        self.assertAlmostEqual(pressure[0] / 2931.98, 1, delta=3e-4)
        shear, c = closed.cattaneo(line, zero, 0.3, 0.5)
        self.assertAlmostEqual(shear[0] / 238.149, 1, delta=1e-5)
        self.assertAlmostEqual(c / 0.707107, 1, delta=1e-6)
        pressure = closed.sliding(line, zero, 0.5)[0]
        self.assertAlmostEqual(pressure / 2661.1747, 1, delta=1e-7)
        self.assertAlmostEqual(closed.Sphere().p0 / 4688.3405, 1, delta=1e-7)
        torque = closed.Torsion().torque(0.5)
        self.assertAlmostEqual(torque / 67.473, 1, delta=1e-5)

    def test_time(self):
        line = closed.Line(P=1.0, E=1e3)
        pressure = closed.lee_radok(line, 2.0, np.zeros(1), 10.0)[0]
        self.assertAlmostEqual(pressure / 1.3732868, 1, delta=1e-4)
        _, _, stress = closed.chaboche(5e-3, 10)
        self.assertAlmostEqual(stress[-1] / 107.33080676, 1, delta=1e-3)
        mass = closed.edge_mass(np.array([0, 0.25, 0.5, 1]))
        np.testing.assert_allclose(mass, [0.5, 0.70274, 0.87703, 1], rtol=1e-3)


class Refused(unittest.TestCase):
    """What cannot be drawn is said in a line."""

    def test_missing_results_are_named(self):
        with self.assertRaisesRegex(
                SystemExit, "^report: nowhere/job: no results.*$"):
            tool("report", "nowhere/job")


if __name__ == "__main__":
    suite = unittest.defaultTestLoader.loadTestsFromModule(
        sys.modules[__name__])
    done = unittest.TextTestRunner(verbosity=2).run(suite)
    bad = len(done.failures) + len(done.errors)
    print(f"{100 * (done.testsRun - bad) // max(done.testsRun, 1)}%: Checks: "
          f"{done.testsRun}, Failures: {len(done.failures)}, Errors: "
          f"{len(done.errors)}")
    sys.exit(bad > 0)
