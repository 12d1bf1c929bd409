#!/usr/bin/python3
"""Meshes of other programs: tools/abaqus_mesh. Runs in the folder of the
sources; PROTIS: the program."""
import contextlib
import csv
import io
import os
import pathlib
import runpy
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.abspath(os.environ.get("PROTIS", "build/release/protis"))

# Two blocks 2 wide and 1 high on each other, the upper one shifted and turned
# by 180 degrees: its side S1 of element 1 is then on top.
ASSEMBLY = """\ufeff*Heading
** Job name: two blocks
*Preprint, echo=NO, model=NO
*PART, NAME=Block
*Node
\t1, 0., .0
 2, 2.D+0, 0.
 3, 2., 1E0,
 4, 0., 1.
*Element, type=CPE3,
 elset=All
 1, 1, 2, 3
 2, 1,
    3, 4
*Nset, nset=Set-1, generate
 1, 4, 3
*Elset, elset=Set-1
 2
*Elset, elset=_Low_S1, internal
 1,
*Surface, type=ELEMENT, name=Low
 _Low_S1, s1
** Section
*Solid Section, elset=ALL, material=M
1.,
*End Part
*Assembly, name=A
*Instance, name=One, part=Block
*End Instance
*Instance, name=Two, part=block
 0., 1., 0.
 1., 1.5, 0., 1., 1.5, 1., 180.
*End Instance
*Node
 1, 7., 7.
*Nset, nset=Reference
 1
*Nset, nset=Corner, instance=Two
 2,
*Nset, nset=Corners
 One.2, Corner, Two.Set-1
*Elset, elset=_Up_S2, internal, instance=One
 2
*Elset, elset=_Up_S2, internal, instance=Two, generate
 2, 2, 1
*Surface, name=Middle
 _Up_S2, S2
*Surface, name=Skin
 One.ALL,
*Surface, name=Mould, type=SEGMENTS
START, 0., 0.
*End Assembly
*Material, name=M
*Step
*Static
0.1, 1., 1e-05, 1.
*End Step"""

DECK = """*MESH, FILE=model.msh
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=ONE.ALL, MATERIAL=M, TYPE=CPE3
*SOLID SECTION, ELSET=TWO.ALL, MATERIAL=M, TYPE=CPE3
*TIE, NAME=JOINT
ONE-MIDDLE, TWO-MIDDLE
*OBSTACLE, NAME=FLOOR, TYPE=CONFORMING
*CONTACT, NAME=FOOT, GROUP=ONE.LOW, OBSTACLE=FLOOR
*STEP
*STATIC
*BOUNDARY
ONE.SET-1, 1, 1, 0.
TWO.SET-1, 1, 1, 0.
*DSLOAD
TWO.LOW, P, 10.
*PRINT, CONTACT, TOTALS
*END STEP
"""

FLAT = """*NODE, NSET=EVERY
100000001, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
5, 1., 1., 1.
*INCLUDE, INPUT=more.inp
*NSET, NSET=FIX, ELSET=BODY
*SURFACE, NAME=BASE, TYPE=ELEMENT
1, S1
1, S2
*SURFACE, NAME=FREE
BODY,
"""
MORE = "*ELEMENT, TYPE=C3D4H\n1, 100000001, 2, 3, 4\n70, 5, 4, 3, 2\n" \
    "*ELEMENT, TYPE=R3D3, ELSET=TOOL\n9, 2, 3, 4\n*ELSET, ELSET=BODY\n1\n"


class Meshes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def convert(self, text, **files):
        """Exit code, lines of standard output, and what was said."""
        (self.dir / "model.inp").write_bytes(text.encode())
        for name, other in files.items():
            (self.dir / f"{name}.inp").write_text(other)
        said, errors, argv, code = io.StringIO(), io.StringIO(), sys.argv, 0
        sys.argv = ["tools/abaqus_mesh", str(self.dir / "model.inp"),
                    str(self.dir / "model.msh")]
        try:  # in this process
            with contextlib.redirect_stdout(said), (
                    contextlib.redirect_stderr(errors)):
                runpy.run_path(sys.argv[0], run_name="__main__")
        except SystemExit as end:
            code = end.code or 0
        finally:
            sys.argv = argv
        return code, said.getvalue().splitlines(), errors.getvalue()

    def test_sets_of_instances_become_groups(self):
        code, groups, said = self.convert(ASSEMBLY.replace("\n", "\r\n"))
        self.assertEqual(code, 0, said)
        self.assertCountEqual(groups, [
            "ONE.ALL: 2 triangles", "TWO.ALL: 2 triangles",
            "ONE.LOW: 1 lines", "TWO.LOW: 1 lines", "MIDDLE: 2 lines",
            "SKIN: 4 lines", "ONE.SET-1: 2 points", "TWO.SET-1: 2 points",
            "CORNER: 1 points", "CORNERS: 4 points",
            "ONE.SET-1_ELEMENTS: 1 triangles",
            "TWO.SET-1_ELEMENTS: 1 triangles"])
        self.assertIn("REFERENCE is left out", said)
        self.assertIn("the elements ONE.SET-1 are ONE.SET-1_ELEMENTS", said)

    def test_run_on_the_mesh_has_the_forces_of_its_loads(self):
        text = ASSEMBLY.replace("name=Middle\n _Up_S2, S2", "name=One-Middle\n "
                                "One._Top, S2\n*Surface, name=Two-Middle\n "
                                "Two._Top, S2")
        text = text.replace("** Section", "*Elset, elset=_Top, internal\n2")
        code, _, said = self.convert(text)
        self.assertEqual(code, 0, said)
        (self.dir / "deck.inp").write_text(DECK)
        said = subprocess.run([PROGRAM, self.dir / "deck", "--quiet"],
                              check=True, capture_output=True, text=True)
        self.assertNotIn("P3", said.stderr)
        table = subprocess.run([PROGRAM, self.dir / "deck", "--table",
                                "CONTACT"], check=True, capture_output=True,
                               text=True).stdout
        rows = list(csv.DictReader(io.StringIO(table)))
        self.assertEqual(len(rows), 2)
        for row in rows:
            self.assertAlmostEqual(float(row["pressure"]), 10.0, places=9)
            self.assertEqual(float(row["y"]), 0.0)

    def test_flat_model_keeps_its_numbers(self):
        code, groups, said = self.convert(FLAT, more=MORE)
        self.assertEqual(code, 0, said)
        self.assertCountEqual(groups, [
            "BASE: 2 triangles", "FREE: 3 triangles", "EVERY: 5 points",
            "FIX: 4 points", "BODY: 1 tetrahedra", "ALL: 2 tetrahedra"])
        self.assertIn("TOOL is left out", said)
        self.assertIn("1 rigid elements, springs or masses are left", said)
        text = (self.dir / "model.msh").read_text()
        self.assertIn("\n2\n3\n4\n5\n100000001\n", text)
        self.assertIn(" 100000001 2 3\n", text)  # S1
        self.assertIn(" 100000001 4 2\n", text)  # S2
        self.assertIn("\n70 5 4 3 2\n", text)

    def test_triangles_beside_tetrahedra_are_faces(self):
        code, groups, said = self.convert(
            FLAT.replace("*INCLUDE, INPUT=more.inp", "*ELEMENT, TYPE=C3D4, "
                         "ELSET=BODY\n1, 100000001, 2, 3, 4\n*ELEMENT, "
                         "TYPE=CPS3, ELSET=SIDE\n2, 2, 3, 4\n"))
        self.assertEqual((code, said), (0, ""))
        self.assertCountEqual(groups, [
            "BASE: 2 triangles", "FREE: 4 triangles", "SIDE: 1 triangles",
            "EVERY: 4 points", "FIX: 4 points", "BODY: 1 tetrahedra"])

    def test_lines_of_other_files_and_lost_numbers(self):
        code, groups, said = self.convert(
            "*NODE, INPUT=more.inp\n*ELEMENT, TYPE=CPE3, INPUT=more2.inp\n"
            "*AMPLITUDE, INPUT=none.inp\n*NSET, NSET=ALL\n1, 7\n"
            "*NSET, NSET=G, GENERATE\n1, 99999999999\n",
            more="1, 0., 0.\n2, 1., 0.\n3, 0., 1.\n2, 1., 0.\n",
            more2="1, 1, 2, 3\n1, 1, 2, 3\n")
        self.assertEqual(code, 0, said)
        self.assertCountEqual(groups, ["ALL: 1 points", "G: 3 points",
                                       "ALL_ELEMENTS: 1 triangles"])
        self.assertEqual(said, "abaqus_mesh: ALL: numbers that the model has "
                         "not: 1, the first 7\n")

    def test_what_is_not_read_is_refused(self):
        model = self.dir / "model.inp"
        node = "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 0., 1.\n"
        body = node + "*ELEMENT, TYPE=CPE3, ELSET=A\n1, 1, 2, 3\n"
        for text, wanted in (
                (node + "*ELEMENT, TYPE=CPE4\n1, 1, 2, 3, 4\n",
                 f"{model}:5: elements CPE4 are not read"),
                (node, "the model has no elements"),
                (body.replace("2, 3\n", "2, 4\n"), "there is no node 4"),
                (body.replace("2, 3\n", "2, 3, 3\n"), "has 4 nodes"),
                (body.replace("2, 3\n", "2\n"), "element 1 is not complete"),
                (body.replace("1., 0.", "1.x, 0."), ":3: '1.x' is no number"),
                (body.replace("1., 0.", "nan, 0."), ":3: 'nan' is no number"),
                (body.replace("3, 0.", "2, 0."), ":4: node 2 is given twice"),
                (body + "1, 1, 3, 2\n", ":7: element 1 is given twice"),
                (body + "*NGEN\n1, 2\n", ":7: *NGEN is not read"),
                (body + "*SURFACE, NAME=S\nA, S4\n",
                 ":8: element 1 has no face S4"),
                (body + "*SURFACE, NAME=S\nB, S1\n", ":8: there is no set B"),
                (body + "*NSET\n1\n", ":7: *NSET needs NSET="),
                (body + "*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n",
                 ":7: there is no part P"),
                (body + "*INCLUDE, INPUT=model.inp\n", "includes itself"),
                (body + "*INCLUDE, INPUT=none.inp\n", "cannot be read"),
                (body + "4, 5., 5., 5.\n*ELEMENT, TYPE=C3D4\n2, 1, 2, 3, 1\n",
                 "is no number")):
            code, groups, said = self.convert(text)
            self.assertEqual((code, groups), (3, []), text)
            self.assertIn(wanted, said)
            self.assertFalse((self.dir / "model.msh").exists())


if __name__ == "__main__":
    result = unittest.main(exit=False, argv=["meshes", *sys.argv[1:]]).result
    bad = len(result.failures) + len(result.errors)
    run = result.testsRun
    print(f"{100 * (run - bad) // max(run, 1)}%: Checks: {run}, "
          f"Failures: {len(result.failures)}, Errors: {len(result.errors)}")
    sys.exit(bad > 0 or run == 0)
