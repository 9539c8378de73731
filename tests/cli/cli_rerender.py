#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc rerender: what an image's header keeps makes the same image again."""

import os
import shutil
import subprocess
import sys

import _h2mc

sys.path.insert(0, os.path.join(_h2mc.SOURCE_DIR, "scenes"))
import exr  # noqa: E402  (what the scenes' scripts share)


# With a text among its definitions.
SCENE = _h2mc.SCENE.replace('<default', '<default name="label" value="none"/><default', 1).replace(
    '<rfilter type="box"/>', '<rfilter type="box"/><string name="label[0, 0]" value="$label"/>')


class Rerender(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", SCENE)

    def same(self, one, other):
        self.assertEqual(self.picture(one), self.picture(other))

    # All that decides on a picture, in the header: bytes and header are the same.
    def test_same_bytes(self):
        for number, arguments in enumerate((
                ["-i", "path", "-s", 4],
                ["-i", "bdpt:maxDepth=4", "-s", 3, "--seed", 18446744073709551615, "--scale", 1.5],
                ["-i", _h2mc.quick("h2mc", "sigma=0.02"), "-m", 8, "--seed", 5, "-D", "radiance=3", "-D", "width=20",
                 "--crop", "2,3,10,9", "--aov", "albedo,variance,mutations", "--aov-samples", 5],
                ["-i", _h2mc.quick("mmlt", "mutationsPerPixel=6"), "--width", 30, "--permissive"],
                ["-i", _h2mc.quick("mmlt-2014"), "-m", 4, "--height", 10, "-D", "label=a b, c=d \"e\" 'f'"])):
            with self.subTest(arguments):
                self.succeeds("render", "scene.xml", *arguments, "-o", f"{number}.exr", "-q")
                result = self.succeeds("rerender", f"{number}.exr", "--threads", 2)
                self.same(f"{number}.exr", f"{number}-again.exr")
                self.assertNotIn("will be another", result.stderr)
                self.assertNotIn("was rendered by version", result.stderr)
                # Also of what was rendered again.
                self.succeeds("rerender", f"{number}-again.exr", "-o", "third.exr", "-q")
                self.same(f"{number}.exr", "third.exr")

    def test_what_is_given_again(self):
        self.succeeds("render", "scene.xml", "-i", "path", "-s", 4, "-o", "a.exr", "-q", "--seed", 1)
        self.succeeds("render", "scene.xml", "-i", "path", "-s", 6, "-o", "b.exr", "-q", "--seed", 2)
        self.succeeds("rerender", "a.exr", "-s", 6, "--seed", 2, "-o", "c.exr", "--png", "--stats", "c.json", "-q")
        self.same("b.exr", "c.exr")
        self.assertEqual(self.report("c.json")["seed"], 2)
        self.assertIn("c.png", self.files())
        # A time goes before the number of samples, and the other way round.
        self.succeeds("rerender", "a.exr", "--time", 0.2, "-o", "d.exr", "-q")
        self.assertNotEqual(self.read_exr("d.exr")[0]["samples"], 4 * 24 * 16)
        self.succeeds("rerender", "d.exr", "-s", 4, "-o", "e.exr", "-q")
        self.same("a.exr", "e.exr")

    def test_from_elsewhere(self):
        os.mkdir(self.path("there"))
        self.succeeds("render", "scene.xml", "-i", "path", "-s", 4, "-o", "there/a.exr", "-q")
        os.mkdir(self.path("other"))
        # Beside the image; then nowhere but where it is said to be.
        shutil.move(self.path("scene.xml"), self.path("there/scene.xml"))
        self.succeeds("rerender", "there/a.exr", "-q")
        self.assertEqual(exr.read(self.path("there/a.exr"))[3], exr.read(self.path("a-again.exr"))[3])
        shutil.move(self.path("there/scene.xml"), self.path("other/s.xml"))
        self.fails(2, "rerender", "there/a.exr", says=('"scene.xml"', "--scene"))
        self.succeeds("rerender", "there/a.exr", "--scene", "other/s.xml", "-o", "b.exr", "-q")

    def test_says_what_differs(self):
        self.succeeds("render", "scene.xml", "-i", "path", "-s", 4, "-o", "a.exr", "-q")
        self.write("scene.xml", SCENE.replace("0.5, 0.5, 0.5", "0.6, 0.5, 0.5"))
        before = self.read_exr("a.exr")[0]["sceneDigest"]
        result = self.succeeds("rerender", "a.exr", "-o", "b.exr")
        now = self.read_exr("b.exr")[0]["sceneDigest"]
        self.assertIn('"scene.xml" has changed since "a.exr" was rendered, or a file that it refers to (digest '
                      f"{before}, now {now})", result.stderr)
        self.assertNotIn("was rendered by version", result.stderr)
        # By another version: of the same length, so that the header stays one.
        self.write("scene.xml", SCENE)
        version = self.read_exr("a.exr")[0]["programVersion"]
        other = "9" + version[1:]
        with open(self.path("a.exr"), "rb") as stream:
            data = stream.read()
        with open(self.path("a.exr"), "wb") as stream:
            stream.write(data.replace(version.encode(), other.encode()))
        result = self.succeeds("rerender", "a.exr", "-o", "b.exr")
        self.assertIn(f'"a.exr" was rendered by version {other}, this is {version}', result.stderr)
        self.assertNotIn("has changed", result.stderr)

    def test_what_can_not_be(self):
        for seed in (1, 2):
            self.succeeds("render", "scene.xml", "-i", "path", "-s", 2, "--seed", seed, "-o", f"{seed}.exr", "-q")
        self.succeeds("merge", "1.exr", "2.exr", "-o", "all.exr", "-q")
        self.fails(2, "rerender", "all.exr", says=("all.exr", "merged"))
        self.fails(2, "rerender", "missing.exr", says="missing.exr")
        self.fails(2, "rerender", "scene.xml", says="scene.xml")
        self.fails(2, "rerender", "1.exr", "-o", "1.exr", says=("are one file", "1.exr"))
        self.fails(2, "rerender", "1.exr", "-o", "scene.xml", says="scene.xml")
        self.fails(2, "rerender", "1.exr", "-s", 4, "--time", 3, says="--time")
        exr.write(self.path("foreign.exr"), 2, 1, [[1.0, 2.0]] * 3)
        self.fails(2, "rerender", "foreign.exr", says=("foreign.exr", "header has no"))

    # Whatever a stranger's header says is a message.
    def test_hostile_requests(self):
        self.succeeds("render", "scene.xml", "-i", "path", "-s", 2, "--crop", "1,2,3,4", "-o", "a.exr", "-q")
        with open(self.path("a.exr"), "rb") as stream:
            data = stream.read()
        request = self.read_exr("a.exr")[0]["renderRequest"].encode()
        self.assertIn(b'"crop":[1,2,3,4]', request)
        for old, new in ((b"[1,2,3,4]", b"[1,2,3,X]"), (b"[1,2,3,4]", b"[1,2,[3]]"), (b"[1,2,3,4]", b'"1,2,3,4"'),
                         (b"[1,2,3,4]", b"[-1,3333]"), (b'"defines":{}', b'"defines":[]'),
                         (b'"defines":{}', b'"defines":7 '), (b'"samplesPerPixel":2.0', b'"samplesPerPixel":-2 '),
                         (request, b"[" * len(request)), (b"[1,2,3,4]", b"[9,9,0,0]")):
            self.assertEqual(len(old), len(new))
            self.assertIn(old, data)
            with open(self.path("a.exr"), "wb") as stream:
                stream.write(data.replace(old, new))
            result = self.run_h2mc("rerender", "a.exr")
            self.assertEqual(result.returncode, 2, (new, result.stderr))

    def test_full_disk(self):
        self.succeeds("render", "scene.xml", "-i", "path", "-s", 2, "-o", "a.exr", "-q")
        result = subprocess.run(["bash", "-c", 'ulimit -f 1; trap "" XFSZ; exec "$0" rerender a.exr -o b.exr',
                                 _h2mc.BINARY], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertNotIn("b.exr", self.files())


if __name__ == "__main__":
    _h2mc.main()
