#!/usr/bin/python3
"""Pages of tools/report in a browser (Debian: chromium, chromium-driver,
python3-selenium, python3-matplotlib, python3-h5py): no message on the console,
nothing asked of a network, pictures drawn, figures shown as JOB.json has them.
Runs in the folder of the sources; PROTIS: the program."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

PROGRAM = os.environ.get("PROTIS", str(pathlib.Path("build/release/protis")))
JOBS = ("greco/greco", "hertz_line/hertz_exact", "hild_triangle/hild_triangle",
        "torsion_sphere_3d/torsion_sphere_3d")
SHOWN = """return [...document.querySelectorAll(arguments[0])].map(e => {
  const r = e.getBoundingClientRect();
  return [r.width, r.height, e.textContent, e.getAttribute('data-json')]; });"""


def browser():
    options = Options()
    for word in ("--headless=new", "--no-sandbox", "--disable-gpu",
                 "--disable-dev-shm-usage", "--window-size=1100,1400"):
        options.add_argument(word)
    options.binary_location = "/usr/bin/chromium"
    options.set_capability("goog:loggingPrefs", {"browser": "ALL",
                                                 "performance": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"),
                            options=options)


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.driver = browser()
        cls.jobs = []
        for name in JOBS:
            subprocess.run([PROGRAM, f"input/{name}.inp", "-o", cls.folder.name,
                            "--quiet"], check=True, stderr=subprocess.DEVNULL)
            job = pathlib.Path(cls.folder.name) / name.split("/")[1]
            subprocess.run(["tools/report", str(job)], check=True,
                           stdout=subprocess.DEVNULL)
            cls.jobs.append(job)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.folder.cleanup()

    def open(self, job):
        self.driver.get_log("browser")
        self.driver.get_log("performance")
        self.driver.get(job.with_suffix(".html").as_uri())

    def test_console_has_no_message(self):
        for job in self.jobs:
            self.open(job)
            self.assertEqual(self.driver.get_log("browser"), [])

    def test_no_request_but_for_the_page(self):
        for job in self.jobs:
            self.open(job)
            asked = [json.loads(e["message"])["message"]
                     for e in self.driver.get_log("performance")]
            asked = [m["params"]["request"]["url"] for m in asked
                     if m["method"] == "Network.requestWillBeSent"]
            self.assertEqual([u for u in asked if not u.startswith(
                ("file:", "data:"))], [])

    def test_pictures_are_drawn(self):
        for job in self.jobs:
            self.open(job)
            shown = self.driver.execute_script(SHOWN, "figure > svg")
            self.assertGreaterEqual(len(shown), 3)
            for width, height, text, _ in shown:
                self.assertGreater(width, 300)
                self.assertGreater(height, 150)
                self.assertGreater(len(text.split()), 8)
            parts = self.driver.execute_script(SHOWN, "svg path, svg image")
            self.assertGreater(sum(w > 0 or h > 0 for w, h, *_ in parts), 50)

    def test_figures_are_those_of_the_json(self):
        for job in self.jobs:
            self.open(job)
            data = json.loads(job.with_suffix(".json").read_text())
            shown = self.driver.execute_script(SHOWN, "data")
            self.assertGreater(len(shown), 40)
            for width, _, text, key in shown:
                value = data
                for part in key.split("."):
                    value = value[int(part) if part.isdigit() else part]
                self.assertGreater(width, 0)
                self.assertEqual(float(text), float(f"{value:.4g}")
                                 if isinstance(value, float) else value)


if __name__ == "__main__":
    suite = unittest.defaultTestLoader.loadTestsFromTestCase(Pages)
    done = unittest.TextTestRunner(verbosity=2).run(suite)
    bad = len(done.failures) + len(done.errors)
    print(f"{100 * (done.testsRun - bad) // max(done.testsRun, 1)}%: Checks: "
          f"{done.testsRun}, Failures: {len(done.failures)}, Errors: "
          f"{len(done.errors)}")
    sys.exit(bad > 0)
