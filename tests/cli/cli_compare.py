#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc compare"""

import csv
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import time
import xml.etree.ElementTree

import _h2mc


class Compare(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("box.xml", _h2mc.SCENE)

    METHODS = "path," + _h2mc.quick("mmlt")
    WORK = ("-m", "8,32", "-k", 2)

    def compare(self, *arguments, scene="box.xml"):
        return self.succeeds("compare", scene, "-i", self.METHODS, "-o", "out", *arguments)

    def reference(self, name="reference.exr", **options):
        self.succeeds("render", "box.xml", "-i", "path", "-s", options.get("samples", 400), "--seed", 99,
                      "-o", name, "--quiet", *options.get("more", ()))
        return name

    def rows(self, folder="out"):
        with open(self.path(os.path.join(folder, "results.csv")), encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def results(self, folder="out"):
        with open(self.path(os.path.join(folder, "results.json")), encoding="utf-8") as stream:
            return json.load(stream)

    def records(self):
        found = {}
        for folder, _, files in os.walk(self.path("out/runs")):
            for name in files:
                found[os.path.join(folder, name)] = os.stat(os.path.join(folder, name)).st_mtime_ns
        return found

    def test_tables_and_resume(self):
        self.reference()
        first = self.compare(*self.WORK, "-r", "reference.exr")
        rows = self.rows()
        self.assertEqual(len(rows), 2 * 2 * 2)  # methods, repeats, marks
        self.assertEqual({row["method"] for row in rows},
                         {"path", "mmlt:bootstrapSamples=4000,chains=32"})
        # The errors are those of diff, to all printed digits.
        for row in rows:
            lines = self.succeeds("diff", "out/" + row["image"], "reference.exr").stdout.splitlines()
            values = dict(line.split() for line in lines)
            for metric in ("relmse", "relmse-trimmed", "mse", "mse-trimmed", "mape", "smape", "hdr-flip"):
                self.assertEqual(float(row[metric]), float(values[metric]), metric)
            self.assertEqual(float(row["mean_ratio"]), float(values["mean-ratio"]))
        # The image of a mark is the image of a render that ends there.
        one = next(r for r in rows if r["method"] == "path" and r["mark"] == "8" and r["repeat"] == "1")
        self.succeeds("render", "box.xml", "-i", "path", "-s", 8, "-o", "alone.exr", "--quiet")
        self.succeeds("diff", "alone.exr", "out/" + one["image"], "--metric", "mse", "--tolerance", 0)

        results = self.results()
        scene = results["scenes"][0]
        summary = next(s for s in scene["summaries"] if s["metric"] == "relmse" and not s["timed"])
        self.assertEqual(summary["position"], 32)
        best = summary["methods"][summary["best"]]
        self.assertEqual(best["verdict"], "best")
        self.assertIn("no difference shown" if summary["methods"][1 - summary["best"]]["rank"] == 1
                      else "worse", first.stdout)
        for name in ("index.html", "results.tex"):
            self.assertTrue(os.path.getsize(self.path("out/" + name)) > 100)
        with open(self.path("out/index.html"), encoding="utf-8") as stream:
            page = stream.read()
        self.assertIsNone(re.search(r"(src|href)\s*=\s*[\"']", page), "the page needs nothing else")

        # Again: nothing is rendered, all comes out the same.
        before, text = self.records(), self.read("out/results.csv")
        again = self.compare(*self.WORK, "-r", "reference.exr")
        self.assertIn("4 of 4 runs are there already", again.stderr)
        self.assertEqual(self.records(), before)
        self.assertEqual(self.read("out/results.csv"), text)
        self.assertEqual(again.stdout, first.stdout)
        # One repeat more: only that is rendered.
        more = self.compare("-m", "8,32", "-k", 3, "-r", "reference.exr")
        self.assertIn("4 of 6 runs are there already", more.stderr)
        for name, when in before.items():
            self.assertEqual(self.records()[name], when)

    def read(self, name):
        with open(self.path(name), encoding="utf-8") as stream:
            return stream.read()

    def test_interrupted_and_resumed(self):
        self.reference()
        command = [_h2mc.BINARY, "compare", "box.xml", "-i", self.METHODS, "-m", "16,300", "-k", "4",
                   "-r", "reference.exr", "-o", "out"]
        with subprocess.Popen(command, cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            deadline = time.monotonic() + 60
            while time.monotonic() < deadline and process.poll() is None and \
                    sum(name.endswith("record.json") for name in self.records()) < 2:
                time.sleep(0.02)
            process.send_signal(signal.SIGINT)
            _, messages = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, messages)
        self.assertIn("goes on from there", messages)
        self.assertFalse(os.path.exists(self.path("out/results.csv")))
        finished = {n: t for n, t in self.records().items()
                    if os.path.exists(os.path.join(os.path.dirname(n), "record.json"))}
        self.assertGreaterEqual(len(finished), 6)  # two runs of two images and a record
        second = self.succeeds(*command[1:])
        self.assertIn("runs are there already", second.stderr)
        after = self.records()
        for name, when in finished.items():
            self.assertEqual(after[name], when, "what was finished is not rendered again")
        # The same as without the interruption, but for the times.
        self.succeeds(*command[1:-1], "other")
        strip = lambda rows: [{k: v for k, v in row.items() if "seconds" not in k and k != "image"}
                              for row in rows]
        self.assertEqual(strip(self.rows()), strip(self.rows("other")))

    def test_time_marks_and_automatic_reference(self):
        result = self.compare("-t", "0.1,0.3", "-k", 1, "--reference-time", 1, "--embed", "all")
        scene = self.results()["scenes"][0]
        for method in scene["methods"]:
            for point in method["repeats"][0]["points"]:
                self.assertGreater(point["seconds"], 0)
        self.assertGreater(scene["reference"]["relmse"], 0)
        self.assertTrue(scene["reference"]["origin"].startswith("bdpt"))
        if not scene["reference"]["goodEnough"]:
            self.assertIn("--reference-time", result.stderr)
        self.assertIn("one repeat", result.stdout)

    def test_reference_integrator_of_the_readme(self):
        self.write("README.md", "# Box\n\nReference integrator: `path:maxDepth=3`, as nothing is hidden.\n")
        self.compare("-m", "4", "-k", 1, "--reference-time", 0.2)
        self.assertTrue(self.results()["scenes"][0]["reference"]["origin"].startswith("path:maxDepth=3,"))

    def test_images_take_a_small_reference_s_size(self):
        self.reference("half.exr", samples=4, more=("--scale", 0.5))
        width, height = self.size("half.exr")
        self.compare("-m", 4, "-k", 1, "-r", "half.exr")
        found = self.results()["scenes"][0]
        self.assertEqual((found["width"], found["height"]), (width, height))
        self.assertEqual(self.size(os.path.join("out", self.rows()[0]["image"])), (width, height))
        # A size that is asked for is kept, and has to fit.
        self.fails(2, "compare", "box.xml", "-i", "path", "-m", 4, "-r", "half.exr", "-o", "out2", "--scale", 1,
                   says="whole multiple")

    def size(self, file):
        x0, y0, x1, y1 = struct.unpack("<4i", self.read_exr(self.path(file))[0]["dataWindow"])
        return x1 - x0 + 1, y1 - y0 + 1

    def test_brightness_is_off_by_more_than_the_reference_knows(self):
        self.reference("bright.exr", more=("-D", "radiance=4.2"))
        command = ("compare", "box.xml", "-i", "path", "-m", 64, "-k", 3, "-r", "bright.exr", "-o")
        self.assertIn("BRIGHTNESS OFF", self.succeeds(*command, "certain").stdout)
        # Pixels known to 100 %, their mean to a few.
        shutil.copy(self.path("bright.exr"), self.path("bright_stderr.exr"))
        self.assertNotIn("BRIGHTNESS OFF", self.succeeds(*command, "uncertain").stdout)

    def test_for_papers(self):
        self.reference()
        shutil.copy(self.path("box.xml"), self.path("a_box & 50%.xml"))
        self.succeeds("compare", "box.xml", "a_box & 50%.xml", "-i", self.METHODS + ",bdpt", *self.WORK, "-r",
                      "reference.exr", "-o", "out")
        wide = self.rows()
        with open(self.path("out/errors.csv"), encoding="utf-8") as stream:
            tidy = list(csv.DictReader(stream))
        metrics = ("relmse", "relmse-trimmed", "mse", "mse-trimmed", "mape", "smape", "hdr-flip")
        self.assertEqual(len(tidy), len(wide) * len(metrics))
        found = {(r["scene"], r["method"], r["repeat"], r["mark"], r["metric"]): r["value"] for r in tidy}
        for row in wide:
            for metric in metrics:
                self.assertEqual(found[row["scene"], row["method"], row["repeat"], row["mark"], metric], row[metric])
        with open(self.path("out/summary.csv"), encoding="utf-8") as stream:
            summary = list(csv.DictReader(stream))
        self.assertEqual(len(summary), 2 * 2 * len(metrics) * 3)  # scenes, axes, metrics, methods
        for group in range(0, len(summary), 3):
            rows = summary[group:group + 3]
            self.assertEqual(rows[0]["verdict"], "best")
            keys = [(int(row["rank"]), float(row["error"])) for row in rows]
            self.assertEqual(keys, sorted(keys))
            for row in rows:  # rank and verdict say the same
                self.assertEqual(int(row["rank"]) > 1, row["verdict"] == "worse", row)

        if not os.path.exists(os.path.join(os.path.dirname(_h2mc.BINARY), "modules", "libh2mc_figures.so")):
            self.assertEqual(os.listdir(self.path("out/figures")), [])
            self.skipTest("no figures: this build was made without libcairo2-dev")
        names = sorted(os.listdir(self.path("out/figures")))
        self.assertEqual(len(names), 2 * 3 * 2)  # scenes, kinds, formats
        for name in names:
            with open(self.path("out/figures/" + name), "rb") as stream:
                data = stream.read()
            if name.endswith(".pdf"):
                self.assertTrue(data.startswith(b"%PDF") and data.rstrip().endswith(b"%%EOF"), name)
                continue
            root = xml.etree.ElementTree.fromstring(data)
            pictures = sum(element.tag.endswith("}image") for element in root.iter())
            # The reference and two places in it, of three methods and the reference.
            self.assertEqual(pictures, 1 + 2 * 4 if "equal-work" in name else 0, name)
        if not shutil.which("pdflatex"):
            self.skipTest("the LaTeX was not compiled: this needs the Debian packages texlive-latex-base and "
                          "texlive-latex-recommended")
        result = subprocess.run(["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "paper.tex"],
                                cwd=self.path("out"), capture_output=True, text=True, errors="replace", check=False)
        self.assertEqual(result.returncode, 0, result.stdout[-3000:])
        self.assertNotIn("undefined", result.stdout)
        if shutil.which("pdftotext"):
            text = subprocess.run(["pdftotext", "out/paper.pdf", "-"], cwd=self.folder, capture_output=True, text=True,
                                  check=True).stdout
            for words in ("relmse", "bdpt", "equal work"):
                self.assertIn(words, text)

    def test_external_images(self):
        self.reference()
        os.makedirs(self.path("images/box"))
        self.reference("images/box/box-0.5s-a.exr", samples=2)
        self.reference("images/box/box-2s-a.exr", samples=8)
        self.compare("-t", "0.2,0.4", "-k", 1, "-r", "{scene}-reference.exr".replace("{scene}-", ""),
                     "--external", "other=images")
        rows = [row for row in self.rows() if row["method"] == "other"]
        # The files' attributes go before their names.
        self.assertEqual(len(rows), 2)
        self.assertEqual({row["integrator"] for row in rows}, {"external"})
        compare = ("compare", "box.xml", "-i", "path", "-m", 4, "-r", "reference.exr", "-o", "out2")
        self.fails(2, *compare, "--external", "other=nowhere", says="nowhere")
        self.fails(2, *compare, "--external", "other", says="name=FOLDER")
        os.makedirs(self.path("empty"))
        self.fails(2, *compare, "--external", "other=empty", says="no EXR files")
        os.makedirs(self.path("wide"))
        self.reference("wide/box-1s.exr", samples=1, more=("--width", 30))
        self.fails(2, *compare, "--external", "other=wide", says="30 x")

    def test_mistakes_are_found_before_anything_is_rendered(self):
        scene = ("compare", "box.xml", "-o", "out")
        self.fails(2, *scene, "-i", "path,mmtl", says=("mmtl", "mmlt"))
        self.fails(2, *scene, "-i", "path,h2mc:sigmma=1", says=("sigmma", "sigma"))
        self.fails(2, *scene, "-i", "h2mc:sigma=x", says="sigma")
        self.fails(2, *scene, "-i", "h2mc:sigma=5", says="sigma")
        self.fails(2, *scene, "-i", "path,path", says="twice")
        self.fails(2, *scene, "-t", "5,3", says="ascending")
        self.fails(2, *scene, "-t", "5,x", says="numbers")
        self.fails(2, *scene, "-m", "2.5", says="whole numbers")
        self.fails(2, *scene, "-t", 1, "-m", 1, says="exclude")
        self.fails(2, *scene, "-k", 0, says="--repeats")
        self.fails(2, *scene, "-r", "nowhere.exr", says="nowhere.exr")
        self.fails(2, *scene, "--reference-integrator", "bdtp", says="bdpt")
        self.fails(2, *scene, "--embed", "some", says="--embed")
        self.fails(2, "compare", "none.xml", "-o", "out", says="none.xml")
        self.fails(2, "compare", "box.xml", says="--output")
        self.fails(2, "compare", "box.xml", "-o", "box.xml", says="box.xml")
        self.write_png("small.png", 5, 5, lambda x, y: (9, 9, 9))
        self.fails(2, *scene, "-r", "small.png", says=("5 x 5", "24 x 16"))


if __name__ == "__main__":
    _h2mc.main()
