#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc list and h2mc info"""

import os
import re

import _h2mc


class List(_h2mc.Test):
    def test_everything(self):
        text = self.succeeds("list").stdout
        for name in ("diffuse", "phong", "roughconductor", "roughdielectric", "conductor",
                     "dielectric", "plastic", "roughplastic", "coating", "roughcoating", "twosided", "mask",
                     "area", "point", "spot", "directional", "constant", "envmap",
                     "serialized", "obj", "ply", "rectangle", "cube", "sphere", "disk",
                     "bitmap", "checkerboard", *_h2mc.INTEGRATORS):
            self.assertRegex(text, rf"(?m)^  {name}( |$)")

    def test_sections(self):
        for section in ("bsdfs", "lights", "shapes", "textures", "integrators", "mutations",
                        "presets"):
            text = self.succeeds("list", section).stdout
            self.assertEqual(re.findall(r"(?m)^\S.*", text), [section])

    def test_mutations_and_presets(self):
        text = self.succeeds("list", "mutations").stdout
        for name in ("isotropic", "hamiltonian", "lens", "bidirectional", "multiplexed"):
            self.assertRegex(text, rf"(?m)^  {name}$")
        self.assertRegex(text, r"trajectoryLength +number ")
        self.assertRegex(self.succeeds("list", "mmlt-2014").stdout, r"mmlt:largeStep=multiplexed,")

    def test_one_entry(self):
        text = self.succeeds("list", "phong").stdout
        self.assertEqual(re.findall(r"(?m)^ ? ?\S.*", text), ["bsdfs", "  phong"])
        self.assertRegex(text, r"exponent +(texture|number) ")

    def test_unknown(self):
        self.fails(2, "list", "bsdfz", says=("bsdfz", "integrators"))

    def test_markdown_has_what_the_text_has(self):
        text = self.succeeds("list").stdout
        markdown = self.succeeds("list", "--markdown").stdout
        self.assertEqual(re.findall(r"(?m)^## (.*)", markdown), re.findall(r"(?m)^(\S.*)", text))
        entries = [name.split(" (also ")[0] for name in re.findall(r"(?m)^  (\S.*)", text)]
        self.assertEqual(re.findall(r"(?m)^### (.*)", markdown), entries)
        self.assertRegex(markdown, r"(?m)^\| `exponent` \| number \| `30` \| of the cosine")
        self.assertRegex(markdown, r"(?m)^Read and not used: .*`sampleVisible`")
        for row in re.findall(r"(?m)^\|.*", markdown):
            self.assertEqual(len(re.findall(r"(?<!\\)\|", row)), 5, row)

    def test_markdown_of_a_part(self):
        markdown = self.succeeds("list", "textures", "--markdown").stdout
        self.assertEqual(re.findall(r"(?m)^##? .*", markdown), ["## textures"])
        markdown = self.succeeds("list", "phong", "--markdown").stdout
        self.assertEqual(re.findall(r"(?m)^#+ .*", markdown), ["## bsdfs", "### phong"])


class Info(_h2mc.Test):
    def test_scene(self):
        self.write("scene.xml", _h2mc.SCENE)
        text = self.succeeds("info", "scene.xml", "-D", "width=40").stdout
        self.assertRegex(text, r"shapes +4 \(1 sphere, 3 triangle mesh\)")
        self.assertRegex(text, r"triangles +6\b")
        self.assertRegex(text, r"bsdfs +\d+ \(\d diffuse\)")
        self.assertRegex(text, r"lights +1 \(1 area\)")
        self.assertRegex(text, r"film +40 x 16, box filter")
        self.assertRegex(text, r"moving +no")
        self.assertRegex(text, r"integrator +not given")

    def test_ring(self):
        text = self.succeeds("info", _h2mc.RING).stdout
        self.assertRegex(text, r"triangles +13,31[0-9]\b")
        self.assertRegex(text, r"integrator +h2mc:maxDepth=")
        self.assertRegex(text, r"film +512 x 384")

    def test_ring_is_what_its_generator_writes(self):
        source = os.path.dirname(_h2mc.RING)
        with open(os.path.join(source, "make_ring.py"), encoding="utf-8") as stream:
            script = self.write("make_ring.py", stream.read())
        self.assertEqual(os.system(f"python3 '{self.path(script)}'"), 0)
        with open(self.path("ring.ply"), "rb") as made:
            with open(os.path.join(source, "ring.ply"), "rb") as kept:
                self.assertEqual(made.read(), kept.read())


if __name__ == "__main__":
    _h2mc.main()
