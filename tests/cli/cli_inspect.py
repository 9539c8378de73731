#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc inspect"""

import base64
import json
import os
import re
import unittest

import _h2mc

QUICK = ("--resolution", 15, "--proposals", 60, "--threads", 1)


class Inspect(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("box.xml", _h2mc.SCENE)

    def read(self, name):
        with open(self.path(name), encoding="utf-8") as stream:
            return stream.read()

    def inspect(self, *arguments):
        return self.succeeds("inspect", "box.xml", *QUICK, *arguments)

    def test_files_and_table(self):
        result = self.inspect("--pixel", "10,12", "-o", "out", "--json", "a.json")
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["close.png", "index.html", "wide.png"])
        for name in ("wide.png", "close.png"):
            with open(self.path(os.path.join("out", name)), "rb") as stream:
                self.assertEqual(stream.read(8), b"\x89PNG\r\n\x1a\n")
        for words in ("pixel 10,12", "eigenvalue", "e1", "deviation", "camera - diffuse", "acceptance",
                      "large", "isotropic", "hamiltonian"):
            self.assertIn(words, result.stdout)

        report = json.loads(self.read("a.json"))
        self.assertEqual(report["pixel"], [10, 12])
        self.assertEqual(int(report["path"]["filmX"] * 24), 10)
        self.assertEqual(int(report["path"]["filmY"] * 16), 12)
        self.assertEqual(len(report["pairs"]), 1)
        pair = report["pairs"][0]
        self.assertEqual((pair["x"], pair["y"]), ("e1", "e2"))
        for view in ("wide", "close"):
            self.assertEqual(len(pair[view]["logRatio"]), 15 * 15)
            self.assertAlmostEqual(pair[view]["logRatio"][15 * 7 + 7], 0, places=5)
        for kind in report["kinds"]:
            self.assertEqual(len(kind["offsets"]), 60)
            self.assertTrue(all(0 <= p <= 1 for p in kind["acceptances"]))
            self.assertAlmostEqual(sum(kind["acceptances"]) / 60, kind["acceptance"], places=5)

        page = self.read("out/index.html")
        self.assertNotRegex(page, r'(src|href)\s*=\s*["\']|https?://(?!www\.w3\.org)|@import|url\(')
        inside = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)
        data = json.loads(inside.group(1))
        self.assertEqual(data["path"], report["path"])
        self.assertEqual(data["model"], report["model"])
        self.assertGreater(len(data["pairs"]), 5)
        self.assertEqual(len(base64.b64decode(data["pairs"][0]["wide"]["logRatio"])), 2 * 15 * 15)

    def test_seed_replay_and_pair(self):
        for name, seed in (("a", 3), ("b", 3), ("c", 4)):
            self.inspect("--pixel", "10,12", "--seed", seed, "-q", "--json", name, "-o", "out")
        self.assertEqual(self.read("a"), self.read("b"))
        first = json.loads(self.read("a"))
        self.assertNotEqual(first["path"]["text"], json.loads(self.read("c"))["path"]["text"])
        result = self.inspect("--replay", first["path"]["text"], "--pair", "u1,u0", "-q", "--json", "d",
                              "--slice-size", 0.5)
        self.assertEqual(result.stdout + result.stderr, "")
        again = json.loads(self.read("d"))
        self.assertEqual(again["path"]["target"], first["path"]["target"])
        self.assertEqual(again["pairs"][0]["x"], "u1")
        self.assertEqual(again["pairs"][0]["wide"]["halfX"], 0.25)
        self.assertTrue(os.path.exists(self.path("box-inspect/index.html")), "the folder by default")

    def test_which_path(self):
        for path in "ridge", "chain", "largest":
            self.inspect("--pixel", "10,12", "--path", path, "-q", "--json", path, "-o", "out")
            self.assertEqual(self.report(path)["path"]["choice"], path)
        self.inspect("--pixel", "10,12", "-q", "--json", "default", "-o", "out")
        self.assertEqual(self.read("default"), self.read("ridge"))
        self.assertAlmostEqual(self.report("chain")["pairs"][0]["wide"]["halfX"], 0.04, places=6)
        self.fails(2, "inspect", "box.xml", "--pixel", "10,12", "--path", "any", says=("--path", "ridge", "largest"))

    def test_the_page_s_own_pixel(self):
        """docs/inspect.md's command finds a ridge, which isotropic steps miss and the Hessian's Gaussian lies along."""
        self.succeeds("inspect", _h2mc.RING, "--pixel", "150,150", *QUICK, "-q", "--json", "ring", "-o", "out")
        report = self.report("ring")
        accepted = {kind["name"]: kind["acceptance"] for kind in report["kinds"]}
        self.assertLess(accepted["isotropic"], 0.1)
        self.assertGreater(accepted["hamiltonian"], 3 * accepted["isotropic"])
        across, along = report["model"]["eigen"][:2]
        self.assertLess(across["value"], -10 * abs(along["value"]))

    def test_methods(self):
        self.inspect("--pixel", "10,12", "-i", "mmlt:maxDepth=3", "--path", "largest", "-o", "out", "--json", "m")
        report = json.loads(self.read("m"))
        self.assertEqual(report["integrator"], "mmlt")
        self.assertNotIn("hamiltonian", [kind["name"] for kind in report["kinds"]])
        self.inspect("--pixel", "10,12", "-i", ":minDepth=9,maxDepth=9", "-o", "out", "--json", "long")
        report = json.loads(self.read("long"))
        self.assertEqual(report["path"]["edges"], 9)
        self.assertTrue(report["model"]["available"])
        self.assertEqual(len(report["model"]["eigen"]), 18)

    def test_mistakes(self):
        def wrong(*arguments, says):
            self.fails(2, "inspect", *arguments, says=says)
        pixel = ("--pixel", "1,1")
        wrong(says="SCENE")
        wrong("box.xml", says="--pixel")
        for bad in ("1", "1,2,3", "1.5,2"):
            wrong("box.xml", "--pixel", bad, says="--pixel")
        for outside in ("24,0", "1,-1"):
            wrong("box.xml", f"--pixel={outside}", says=(outside, "24 x 16"))
        wrong("none.xml", *pixel, says="none.xml")
        wrong("box.xml", *pixel, "-i", "path", says=("path", "h2mc", "mmlt"))
        wrong("box.xml", *pixel, "-i", "h3mc", says=("h3mc", "h2mc"))
        wrong("box.xml", *pixel, "-i", "h2mc:sigma=0", says="sigma")
        wrong("box.xml", *pixel, "-i", "h2mc:minDepth=4,maxDepth=3", says=("minDepth", "maxDepth"))
        wrong("box.xml", *pixel, "--pair", "e1,u1", says="--pair")
        wrong("box.xml", "--pixel", "10,12", "--pair", "e1,e900", says=("e900", "e1"))
        wrong("box.xml", *pixel, "--resolution", 1, says="--resolution")
        wrong("box.xml", *pixel, "--slice-size", 0, says="--slice-size")
        wrong("box.xml", *pixel, "--json", "nowhere/a.json", says="nowhere")
        wrong("box.xml", *pixel, "-o", "box.xml/out", says="box.xml/out")
        wrong("box.xml", *pixel, "--replay", "s=0 t=2 u=0,0", says="--replay")
        wrong("box.xml", "--replay", "s=0 t=2 u=0,2", says="[0, 1)")
        wrong("box.xml", "--replay", "s=0 t=2 u=0.5,0.9", says="no light")

        os.makedirs(self.path("taken/index.html"))
        wrong("box.xml", *pixel, "-o", "taken", says="taken")

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_folder_that_is_not_writable(self):
        os.mkdir(self.path("locked"), 0o555)
        self.fails(2, "inspect", "box.xml", "--pixel", "1,1", "-o", "locked", says="locked")

    def test_dark(self):
        dark = _h2mc.SCENE.replace('<rotate x="1" angle="90"/>', '<rotate x="1" angle="-90"/>')
        self.assertNotEqual(dark, _h2mc.SCENE)
        self.write("dark.xml", dark)
        self.fails(1, "inspect", "dark.xml", "--pixel", "10,12", "-o", "out", says=("no light", "10,12"))


if __name__ == "__main__":
    _h2mc.main()
