#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc stress"""

import re
import shlex
import signal
import subprocess
import time

import _h2mc

QUICK = ("--paths", 40, "--samples", 4000, "--width", 16, "--max-depth", 3)
# What changes nothing in a scene of diffuse surfaces.
LEFT_OUT = {"alpha=1", "alpha=1e-4", "exponent=1", "exponent=1e6", "ior=1", "ior=1.0001"}


class Stress(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)

    def test_all_variations(self):
        result = self.succeeds("stress", "scene.xml", *QUICK, "--json", "a.json")
        report = self.report("a.json")
        names = [v["name"] for v in report["variations"]]
        self.assertEqual(names[0], "as-is")
        self.assertLessEqual({"scale=1e-4", "scale=1e6", "moved=1e6", "lights=1e-6",
                              "radiance=1e-30", "radiance=1e30", "length=32", "u=0", "u=1"},
                             set(names))
        self.assertLessEqual(LEFT_OUT, set(report["leftOut"]))
        self.assertEqual(report["failed"], 0)
        for v in report["variations"]:
            self.assertEqual(v["notFinite"], 0, v)
            self.assertGreater(v["paths"], 10, v)
            self.assertLess(v["hessian"]["median"], 1e-3, v)
            self.assertRegex(v["hessian"]["worstReplay"], "^s=")
            self.assertIn(v["name"], result.stdout)
            if v["name"].startswith("u="):
                self.assertIsNone(v["pictures"])
            else:
                self.assertEqual(v["pictures"]["brokenPixels"], 0)
        of = {v["name"]: v["pictures"]["bdpt"]["mean"] for v in report["variations"]
              if v["pictures"]}
        self.assertAlmostEqual(of["radiance=1e30"] / of["as-is"] / 1e30, 1, 3)
        self.assertAlmostEqual(of["moved=1e6"] / of["as-is"], 1, 1)
        self.assertIn("changes nothing here: alpha=1, ", result.stdout)
        self.assertIn("worst Hessian", result.stdout)

        # What the table says to look at the worst path with.
        command = re.search(r"^worst Hessian: \S+ h2mc (.*)$", result.stdout, re.M).group(1)
        shown = self.succeeds(*shlex.split(command))
        self.assertIn("H[1,0]", shown.stdout)

    def test_only(self):
        self.succeeds("stress", "scene.xml", *QUICK, "--only", "scale,u=0", "--json", "a.json", "-q")
        self.assertEqual([v["name"] for v in self.report("a.json")["variations"]],
                         ["scale=1e-4", "scale=1e-2", "scale=1e3", "scale=1e6", "u=0"])
        self.succeeds("stress", "scene.xml", "--paths", 40, "--samples", 0, "--only", "as-is",
                      "--json", "b.json", "-q", "-D", "radiance=2")
        self.assertIsNone(self.report("b.json")["variations"][0]["pictures"])

    def test_seed(self):
        def findings(name):
            variations = self.report(name)["variations"]
            for v in variations:
                del v["seconds"]
            return variations
        for name, seed, threads in (("a", 3, 1), ("b", 3, 2), ("c", 4, 1)):
            self.succeeds("stress", "scene.xml", *QUICK, "--only", "as-is", "--seed", seed,
                          "--threads", threads, "-q", "--json", name)
        self.assertEqual(findings("a"), findings("b"))
        self.assertNotEqual(findings("a"), findings("c"))

    def test_bad_input(self):
        for option in ("--paths", "--max-depth", "--threads", "--width"):
            for bad in ("0", "-1", "x"):
                self.fails(2, "stress", "scene.xml", option, bad, says=option)
        self.fails(2, "stress", "scene.xml", "--samples", "-1", says="--samples")
        self.fails(2, "stress", "scene.xml", "--seed", "-1", says="--seed")
        self.fails(2, "stress", "scene.xml", "--only", "alpah", says=("--only", "alpah", "alpha="))
        self.fails(2, "stress", "scene.xml", "--only", "alpha", *QUICK, says="changes anything")
        self.fails(2, "stress", says="SCENE")
        self.fails(2, "stress", "none.xml", says="none.xml")
        self.fails(2, "stress", "none.xml", "--json", "nowhere/a.json", says="nowhere")
        self.fails(2, "stress", "scene.xml", "--replay", "s=0 t=2 u=0,0", says="--only")
        self.fails(2, "stress", "scene.xml", "--replay", "s=0", "--only", "as-is", says="t=")
        self.fails(2, "stress", "scene.xml", "--replay", "s=0 t=2 u=0,0 choice=", "--only",
                   "alpha=1", says="changes nothing")
        self.write("broken.xml", _h2mc.SCENE.replace('type="sphere"', 'type="spheer"'))
        self.fails(2, "stress", "broken.xml", says='did you mean "sphere"')

    def test_dark(self):
        away = _h2mc.SCENE.replace('<rotate x="1" angle="90"/>', '<rotate x="1" angle="-90"/>')
        self.assertNotEqual(away, _h2mc.SCENE)
        self.write("dark.xml", away)
        self.fails(1, "stress", "dark.xml", *QUICK, "--only", "as-is", says="no light")

    def test_interrupted(self):
        with subprocess.Popen([_h2mc.BINARY, "stress", "scene.xml", "--samples", "100000000",
                               "--json", "a.json"], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            _h2mc.wait_for_handler(process)
            time.sleep(1)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("interrupted after 0 of", errors)
        self.assertEqual(self.report("a.json")["variations"], [])


if __name__ == "__main__":
    _h2mc.main()
