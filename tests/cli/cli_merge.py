#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc merge: the mean of renders that differ in their seeds, and what does not belong together."""

import os
import re
import shutil
import struct
import subprocess
import sys

import _h2mc

sys.path.insert(0, os.path.join(_h2mc.SOURCE_DIR, "scenes"))
import exr  # noqa: E402  (what the scenes' scripts share)

SUMS = ("samples", "wallSeconds", "cpuSeconds")


class Merge(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)

    def render(self, name, seed, *more, integrator="path", budget=8):
        option = "-s" if integrator in _h2mc.SAMPLERS else "-m"
        self.succeeds("render", "scene.xml", "-i", _h2mc.quick(integrator), option, budget, "--seed", seed, "-o", name,
                      "-q", *more)
        return name

    def pixels(self, name):
        _, width, height, planes = exr.read(self.path(name))
        self.assertEqual((width, height), (24, 16))
        return [value for plane in planes for value in plane]

    def attributes(self, name):
        return self.read_exr(name)[0]

    def error(self, name, reference):
        """The mean square error, of the reference's mean squared."""
        pairs = list(zip(self.pixels(name), self.pixels(reference), strict=True))
        return sum((a - r) ** 2 for a, r in pairs) * len(pairs) / sum(r for _, r in pairs) ** 2

    def refused(self, *images, says):
        """With the file's names in the message; an old output stays."""
        self.write("out.exr", "old")
        result = self.fails(2, "merge", *images, "-o", "out.exr", says=says)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        with open(self.path("out.exr"), encoding="utf-8") as old:
            self.assertEqual(old.read(), "old")

    def test_weighted_mean(self):
        for integrator, unit in (("path", "samples"), ("h2mc", "mutations")):
            with self.subTest(integrator):
                names = [self.render(f"{seed}.exr", seed, integrator=integrator, budget=budget)
                         for seed, budget in ((3, 4), (1, 16), (18446744073709551615, 7))]
                result = self.succeeds("merge", *names, "-o", "all.exr")
                self.assertIn("3 images", result.stderr)
                self.assertEqual(result.stdout, "")
                parts = [self.attributes(name) for name in names]
                merged = self.attributes("all.exr")
                work = [part["samples"] for part in parts]
                self.assertEqual(len(set(work)), 3)
                columns = zip(*(self.pixels(name) for name in names))
                for found, values in zip(self.pixels("all.exr"), columns, strict=True):
                    mean = sum(w * v for w, v in zip(work, values)) / sum(work)
                    self.assertAlmostEqual(found, mean, delta=1e-6 * (1 + mean))
                for name in SUMS:
                    self.assertAlmostEqual(merged[name], sum(part[name] for part in parts), 9)
                self.assertEqual(merged["seeds"], "1,3,18446744073709551615")
                self.assertNotIn("seed", merged)
                self.assertEqual(merged["sampleUnit"], unit)
                mean = sum(part["samples"] * part["meanLuminance"] for part in parts) / sum(work)
                self.assertAlmostEqual(merged["meanLuminance"], mean, 9)
                deviation = sum((part["samples"] * part["meanLuminanceError"]) ** 2 for part in parts) ** 0.5
                self.assertAlmostEqual(merged["meanLuminanceError"], deviation / sum(work), 9)
                for name in ("scene", "sceneDigest", "integrator", "programVersion", "interrupted"):
                    self.assertEqual(merged[name], parts[0][name])
                self.assertNotRegex(merged["integratorOptions"], "PerPixel")
                self.assertRegex(merged["integratorOptions"], "(^|,)maxDepth=-1(,|$)")

    def test_in_any_order(self):
        a, b, c = (self.render(f"{seed}.exr", seed, budget=seed) for seed in (1, 2, 5))
        self.succeeds("merge", a, b, c, "-o", "all.exr", "-q")
        self.succeeds("merge", a, b, "-o", "ab.exr", "-q")
        self.succeeds("merge", c, "ab.exr", "-o", "again.exr", "-q")
        for one, other in zip(self.pixels("all.exr"), self.pixels("again.exr"), strict=True):
            self.assertAlmostEqual(one, other, delta=1e-6 * (1 + one))
        for name, value in self.attributes("all.exr").items():
            other = self.attributes("again.exr")[name]
            if isinstance(value, float):
                self.assertAlmostEqual(value, other, 9)
            else:
                self.assertEqual(value, other, name)
        self.refused("ab.exr", b, says=("ab.exr", "2.exr", "seed 2 is in both"))
        self.refused("again.exr", "ab.exr", says="seed 1 is in both")

    def test_one_image_stays_what_it_is(self):
        self.render("a.exr", 4, budget=2)
        self.assertIn("1 image,", self.succeeds("merge", "a.exr", "-o", "b.exr").stderr)
        self.assertEqual(self.pixels("a.exr"), self.pixels("b.exr"))
        self.assertEqual(self.attributes("b.exr")["seed"], "4")

    # What docs/clusters.md says, on one machine, by fixed seeds. The mean of 16 images has a sixteenth of the error of
    # one of them where they are independent; a half of that gain is asked for.
    def test_an_array_of_jobs(self):
        with open(os.path.join(_h2mc.SOURCE_DIR, "docs", "clusters.md"), encoding="utf-8") as page:
            script = re.search(r"(?ms)^    (#!/bin/bash\n.*?)^[^ \n]", page.read())[1]
        script = re.sub("(?m)^    ", "", script)
        self.assertIn("--seed $SLURM_ARRAY_TASK_ID", script)
        self.write("job.sh", script)
        self.write("ring.xml", _h2mc.SCENE)
        self.succeeds("render", "scene.xml", "-i", "bdpt", "-s", 3000, "-o", "long.exr", "-q")
        for integrator in ("path", "mmlt"):
            with self.subTest(integrator):
                budget = "-s" if integrator == "path" else "-m"
                os.makedirs(self.path("bin"), exist_ok=True)
                self.write("bin/h2mc", f'#!/bin/bash\nexec "{_h2mc.BINARY}" "$@" -q -i {_h2mc.quick(integrator)} '
                                       f"{budget} 64\n")
                os.chmod(self.path("bin/h2mc"), 0o755)
                script = re.sub(r" --time \S+", "", script)
                self.write("job.sh", script)
                for task in range(1, 17):
                    environment = dict(os.environ, SLURM_ARRAY_TASK_ID=str(task), SLURM_CPUS_PER_TASK="1",
                                       PATH=self.path("bin") + ":" + os.environ["PATH"])
                    job = subprocess.run(["bash", "job.sh"], cwd=self.folder, env=environment, capture_output=True,
                                         text=True, check=False)
                    self.assertEqual(job.returncode, 0, job.stderr)
                parts = sorted(name for name in self.files() if re.fullmatch(r"ring-\d+\.exr", name))
                self.assertEqual(len(parts), 16)
                self.succeeds("merge", *parts, "-o", "ring.exr")
                one = sum(self.error(part, "long.exr") for part in parts) / 16
                self.assertLess(self.error("ring.exr", "long.exr"), one / 8)

    def test_scene(self):
        self.render("a.exr", 1)
        self.render("b.exr", 2, "-D", "radiance=5")
        self.refused("a.exr", "b.exr", says=("a.exr", "b.exr", "-D", "radiance=5"))
        # The same scene in another folder, by another name's folder.
        os.mkdir(self.path("copy"))
        shutil.copy(self.path("scene.xml"), self.path("copy/scene.xml"))
        self.succeeds("render", self.path("copy/scene.xml"), "-i", "path", "-s", 8, "--seed", 2, "-o", "c.exr")
        self.succeeds("merge", "a.exr", "c.exr", "-o", "ac.exr")
        # A scene that has changed, and one that always was another.
        text = _h2mc.SCENE.replace("0.5, 0.5, 0.5", "0.6, 0.5, 0.5")
        self.write("scene.xml", text)
        self.render("d.exr", 4)
        self.refused("a.exr", "d.exr", says=("d.exr", '"scene.xml"', "has changed"))
        self.write("other.xml", text)
        self.succeeds("render", "other.xml", "-i", "path", "-s", 8, "--seed", 5, "-o", "e.exr")
        self.refused("a.exr", "e.exr", says=("e.exr", '"scene.xml" and "other.xml" are not the same'))

    def test_a_file_of_the_scene(self):
        texture = '<texture type="bitmap" name="reflectance"><string name="filename" value="t.png"/></texture>'
        self.write("scene.xml", _h2mc.SCENE.replace('<rgb name="reflectance" value="0.5, 0.5, 0.5"/>', texture))
        self.write_png("t.png", 4, 4, lambda x, y: (90, 90, 90))
        self.render("a.exr", 1)
        self.write_png("t.png", 4, 4, lambda x, y: (90, 90, 91))
        self.render("b.exr", 2)
        self.refused("a.exr", "b.exr", says=("a file that it refers to", "has changed"))

    def test_other_renders(self):
        self.render("a.exr", 1)
        self.render("size.exr", 2, "-D", "width=24", "--width", 30)
        self.refused("a.exr", "size.exr", says="size.exr")
        self.render("size.exr", 2, "--width", 30)
        self.refused("a.exr", "size.exr", says=("size.exr", "24 x 16 in one and 30 x 20 in the other"))
        self.render("bdpt.exr", 2, integrator="bdpt")
        self.refused("a.exr", "bdpt.exr", says=("bdpt.exr", "integrator is path in one and bdpt in the other"))
        self.succeeds("render", "scene.xml", "-i", "path:maxDepth=3", "-s", 8, "--seed", 2, "-o", "depth.exr")
        self.refused("a.exr", "depth.exr", says=("depth.exr", "option maxDepth is -1 in one and 3 in the other"))
        self.render("same.exr", 1, budget=9)
        self.refused("a.exr", "same.exr", says=("a.exr", "same.exr", "seed 1 is in both"))
        self.refused("a.exr", "a.exr", says="seed 1 is in both")
        # The budget is no such option, however it was given.
        self.succeeds("render", "scene.xml", "-i", "path:samplesPerPixel=4", "--seed", 6, "-o", "budget.exr")
        self.succeeds("merge", "a.exr", "budget.exr", "-o", "more.exr")

    # Bytes of a header, of which the length stays as it was.
    def changed(self, name, old, new, to):
        self.assertEqual(len(old), len(new))
        with open(self.path(name), "rb") as stream:
            data = stream.read()
        self.assertEqual(data.count(old), 1)
        with open(self.path(to), "wb") as stream:
            stream.write(data.replace(old, new))
        return to

    def test_headers(self):
        self.render("a.exr", 1)
        self.render("b.exr", 2)
        version = self.attributes("b.exr")["programVersion"].encode()
        other = self.changed("b.exr", version, b"9" + version[1:], "version.exr")
        self.refused("a.exr", other, says=("version.exr", "program version is", "9" + version[1:].decode()))
        none = self.changed("b.exr", b"sceneDigest\0", b"sceneDigesd\0", "none.exr")
        self.refused("a.exr", none, says=("none.exr", "its header has no sceneDigest", "expected an EXR"))
        seeds = self.changed("b.exr", b"seed\0string\0\1\0\0\0" + b"2", b"seed\0string\0\1\0\0\0" + b"x", "seeds.exr")
        self.refused("a.exr", seeds, says=("seeds.exr", "seeds of its header are no list"))
        samples = b"samples\0double\0\10\0\0\0"
        for value in (0, -1, float("nan"), 1e300):
            bad = self.changed("b.exr", samples + struct.pack("<d", 8 * 24 * 16), samples + struct.pack("<d", value),
                               "samples.exr")
            self.refused("a.exr", bad, says=("samples.exr", "samples"))
        # Pictures of other programs.
        self.write_png("p.png", 24, 16, lambda x, y: (9, 9, 9))
        self.refused("a.exr", "p.png", says="p.png")
        exr.write(self.path("foreign.exr"), 24, 16, [[0.5] * 384] * 3)
        self.refused("foreign.exr", "a.exr", says=("foreign.exr", "its header has no programVersion"))
        self.refused("a.exr", "missing.exr", says="missing.exr")
        self.write("text.exr", "no picture")
        self.refused("a.exr", "text.exr", says="text.exr")

    def test_pixels(self):
        self.render("a.exr", 1)
        self.render("b.exr", 2)
        channels = self.changed("b.exr", b"B\0\2\0\0\0", b"A\0\2\0\0\0", "channels.exr")
        self.refused("a.exr", channels, says=("channels.exr", "its channels are A, G, R"))
        with open(self.path("b.exr"), "rb") as stream:
            data = stream.read()
        with open(self.path("cut.exr"), "wb") as stream:
            stream.write(data[:-400])
        self.refused("a.exr", "cut.exr", says="cut.exr")
        attributes, width, height, planes = exr.read(self.path("b.exr"))
        planes[1][7] = float("nan")
        exr.write(self.path("new.exr"), width, height, planes)
        with open(self.path("new.exr"), "rb") as stream:
            new = stream.read()
        known = ("seed", "scene", "sceneDigest", "integrator", "integratorOptions", "sampleUnit", "programVersion")
        added = b"".join(key.encode() + b"\0string\0" + struct.pack("<i", len(attributes[key])) + attributes[key]
                         for key in known)
        for key in ("wallSeconds", "cpuSeconds", "samples", "meanLuminance", "meanLuminanceError"):
            added += key.encode() + b"\0double\0\10\0\0\0" + attributes[key]
        for key in ("threads", "interrupted"):
            added += key.encode() + b"\0int\0\4\0\0\0" + attributes[key]
        # The table of the lines' places follows the header, which is longer now.
        end = new.index(b"screenWindowWidth\0float\0\4\0\0\0") + len(b"screenWindowWidth\0float\0\4\0\0\0") + 4
        place = struct.unpack_from("<Q", new, end + 1)[0]
        with open(self.path("nan.exr"), "wb") as stream:
            stream.write(new[:end] + added + b"\0" + struct.pack("<Q", place + len(added)) + new[end + 9:])
        self.refused("a.exr", "nan.exr", says=("nan.exr", "1 of its pixels are not finite"))

    def test_outputs(self):
        self.render("a.exr", 1)
        self.render("b.exr", 2)
        before = self.picture("a.exr")
        self.fails(2, "merge", "a.exr", "b.exr", "-o", "a.exr", says=("are one file", "a.exr"))
        self.fails(2, "merge", "a.exr", "b.exr", "-o", "./b.exr", says=("are one file", "b.exr"))
        self.assertEqual(self.picture("a.exr"), before)
        self.fails(2, "merge", "a.exr", "b.exr", says="--output")
        self.fails(2, "merge", "-o", "out.exr", says="IMAGE")
        self.fails(2, "merge", "a.exr", "-o", "out.tga", says="out.tga")
        self.fails(2, "merge", "a.exr", "-o", "nowhere/out.exr", says="nowhere")
        self.fails(2, "merge", "a.exr", "b.exr", "-o", "out.exr", "--max-texture-pixels", 100, says="24 x 16")
        self.succeeds("merge", "a.exr", "b.exr", "-o", "out.png", "-q")
        self.assertIn("out.png", self.files())

    def test_a_full_disk_leaves_the_old_file(self):
        self.render("a.exr", 1)
        self.write("out.exr", "old")
        files = self.files()
        result = subprocess.run(["bash", "-c", 'ulimit -f 1; trap "" XFSZ; exec "$0" merge a.exr -o out.exr',
                                 _h2mc.BINARY], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("out.exr", result.stderr)
        self.assertEqual(self.files(), files)
        with open(self.path("out.exr"), encoding="utf-8") as old:
            self.assertEqual(old.read(), "old")


if __name__ == "__main__":
    _h2mc.main()
