#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc gradcheck"""

import json
import re
import shlex

import _h2mc

QUICK = ("--paths", 60, "--max-depth", 4)


class Gradcheck(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)

    def test_a_scene_that_is_right(self):
        result = self.succeeds("gradcheck", "scene.xml", *QUICK, "--json", "a.json",
                               "--html", "a.html")
        for words in ("technique (s,t)", "(0,3)", "(1,2)", "diffuse", "area", "still", "bdpt",
                      "chain", "all"):
            self.assertIn(words, result.stdout)
        report = self.report("a.json")
        self.assertEqual(report["pathsOutOfTolerance"], 0)
        total = report["total"]
        self.assertEqual(total["paths"], 60)
        self.assertEqual(total["outOfTolerance"], 0)
        self.assertGreater(total["entriesJudged"], 9 * total["entriesNotJudged"])
        self.assertLess(total["hessian"]["worst"], 1e-6)
        self.assertLess(total["hessian"]["median"], 1e-8)
        self.assertGreater(total["hessian"]["median"], 0)
        titles = [group["title"] for group in report["groups"]]
        self.assertEqual(titles[:2], ["technique (s,t)", "BSDF at a vertex"])
        self.assertEqual(sum(row["paths"] for row in report["groups"][0]["rows"]), 60)
        self.assertEqual({f["name"] for f in report["forms"]}, set(total["forms"]))

        with open(self.path("a.html"), encoding="utf-8") as stream:
            page = stream.read()
        inside = re.search(r'<script type="application/json" id="report">(.*?)</script>', page, re.S)
        self.assertEqual(json.loads(inside.group(1)), report)
        self.assertNotRegex(page, r'(src|href)\s*=|https?://|@import|url\(')

    def test_seed(self):
        for name, seed in (("a", 3), ("b", 3), ("c", 4)):
            self.succeeds("gradcheck", "scene.xml", *QUICK, "--seed", seed, "-q",
                          "--threads", 1 if name == "a" else 2, "--json", name)
        self.assertEqual(self.report("a"), self.report("b"))
        self.assertNotEqual(self.report("a")["worst"], self.report("c")["worst"])

    def test_out_of_tolerance_and_replay(self):
        # Nothing in float is as good as this.
        result = self.run_h2mc("gradcheck", "scene.xml", *QUICK, "--float-tolerance", 1e-9,
                               "--json", "a.json")
        self.assertEqual(result.returncode, 1)
        self.assertIn("out of tolerance", result.stderr)
        self.assertIn("seed 0", result.stderr)
        report = self.report("a.json")
        self.assertGreater(report["pathsOutOfTolerance"], 0)

        # What the message says to look at it alone with.
        command = shlex.split(re.search(r"^  h2mc (gradcheck .*)$", result.stderr, re.M).group(1))
        self.assertEqual(self.run_h2mc(*command, "--float-tolerance", 1e-9).returncode, 1)
        for worst in report["worst"][:4]:
            replayed = self.run_h2mc("gradcheck", "scene.xml", "--replay", worst["replay"],
                                     "--float-tolerance", 1e-9, "--json", "b.json")
            again = self.report("b.json")["worst"][0]
            for key in ("valueError", "gradientError", "hessianError", "verdict", "entries",
                        "sweep"):
                self.assertEqual(again[key], worst[key])
            for form, errors in worst["forms"].items():
                for key in ("value", "gradient", "hessian"):
                    self.assertEqual(again["forms"][form][key], errors[key])
            self.assertIn("H[1,0]", replayed.stdout)
            self.assertIn("diffuse", replayed.stdout)

    def test_bad_input(self):
        for option in ("--paths", "--tolerance", "--float-tolerance", "--max-depth", "--threads"):
            for bad in ("0", "-1", "x"):
                self.fails(2, "gradcheck", "scene.xml", option, bad, says=option)
        self.fails(2, "gradcheck", "scene.xml", "--max-depth", 33, says="--max-depth")
        self.fails(2, "gradcheck", "scene.xml", "--seed", "-1", says="--seed")
        self.fails(2, "gradcheck", says="SCENE")
        self.fails(2, "gradcheck", "none.xml", says="none.xml")
        self.fails(2, "gradcheck", "none.xml", "--json", "nowhere/a.json", says="nowhere")
        self.fails(2, "gradcheck", "none.xml", "--html", "/dev/null", says="/dev/null")
        self.fails(2, "gradcheck", "none.xml", "--replay", "s=1", says=("--replay", "t="))
        self.fails(2, "gradcheck", "scene.xml", "--replay", "s=0 t=2 u=0,2", says="[0, 1)")
        self.fails(2, "gradcheck", "scene.xml", "--replay", "s=0 t=2 u=0,0", says="no light")
        self.fails(2, "gradcheck", "scene.xml", "--replay", "s=0 t=2 u=0,0", "--paths", 5,
                   says="--paths")

    def test_dark(self):
        away = _h2mc.SCENE.replace('<rotate x="1" angle="90"/>', '<rotate x="1" angle="-90"/>')
        self.assertNotEqual(away, _h2mc.SCENE)
        self.write("dark.xml", away)
        self.fails(1, "gradcheck", "dark.xml", *QUICK, says="no light")


if __name__ == "__main__":
    _h2mc.main()
