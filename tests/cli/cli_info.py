#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc info names every value that is not used as it stands in the file, with both values."""

import re
import unittest

import _h2mc

GREY = re.search(r'<bsdf type="diffuse" id="grey">.*?</bsdf>', _h2mc.SCENE).group(0)
END = "</scene>"
HEADING = "Changed on the way in:\n"

# What stands in the good scene, what stands there instead, and the line that follows its place.
CHANGES = {
    "roughness": (GREY, '<bsdf type="roughplastic" id="grey"><float name="alpha" value="1e-9"/></bsdf>',
                  '"alpha" of bsdf "roughplastic": 1e-09 in the file, used: 0.0001'),
    "roughness 0": (GREY, '<bsdf type="roughconductor" id="grey"><float name="alpha" value="0"/></bsdf>',
                    '"alpha" of bsdf "roughconductor": 0 in the file, used: 0.0001'),
    "reflectance": (GREY, '<bsdf type="diffuse" id="grey"><rgb name="reflectance" value="2, 1, 1"/></bsdf>',
                    '"reflectance" of bsdf "diffuse": up to 2 in the file, used: times 0.495, to conserve energy'),
    "spectrum": (GREY, '<bsdf type="diffuse" id="grey">'
                       '<spectrum name="reflectance" value="500:0, 510:1, 520:1, 530:0"/></bsdf>',
                 '"reflectance" of bsdf "diffuse": a spectrum beyond Rec. 709, (-'),
    "weights": (GREY, '<bsdf type="mixturebsdf" id="grey"><string name="weights" value="1, 3"/>'
                      '<bsdf type="diffuse"/><bsdf type="diffuse"/></bsdf>',
                '"weights" of bsdf "mixturebsdf": a sum of 4 in the file, used: a sum of 1, to conserve energy'),
    "metal": (GREY, '<bsdf type="conductor" id="grey"><rgb name="k" value="-1, 2, 3"/></bsdf>',
              '"k" of bsdf "conductor": (-1, 2, 3) in the file, used: its absolute value'),
    "length": (END, '<integrator type="path"><integer name="maxDepth" value="1000"/></integrator></scene>',
               '"maxDepth" of the integrator: 1000 in the file, used: 32'),
    "no limit": (END, '<integrator type="path"><integer name="maxDepth" value="-1"/></integrator></scene>',
                 '"maxDepth" of the integrator: -1, no limit in the file, used: 32'),
    "hidden": (END, '<integrator type="path"><boolean name="hideEmitters" value="true"/></integrator></scene>',
               '"minDepth" of the integrator: 1 in the file, used: 2, by hideEmitters'),
    "radiance": ('name="radiance" value="$radiance, $radiance, $radiance"', 'name="radiance" value="1e30"',
                 "what lights emit: as it is in the file, used: in units of"),
    "direction": (END, '<emitter type="directional"><vector name="direction" x="0" y="-3" z="0"/></emitter></scene>',
                  '"direction" of emitter "directional": a direction of length 3 in the file, used: of length 1'),
    "camera": ('<transform name="toWorld"><lookat origin="0, 1, 5"',
               '<transform name="toWorld"><scale value="2"/><lookat origin="0, 1, 5"',
               '"toWorld" of sensor "perspective": a scale of 2 in the file, used: none: a camera has no size'),
    "tiny": ('<float name="fov" value="40"/>',
             '<float name="fov" value="40"/><float name="shutterOpen" value="1e-60"/>',
             '"shutterOpen" of sensor "perspective": 1e-60 in the file, used: 0, the nearest float'),
}


class Info(_h2mc.Test):
    def changes(self, text):
        self.write("scene.xml", text)
        output = self.succeeds("info", "scene.xml").stdout
        return output.split(HEADING)[1].splitlines() if HEADING in output else []

    def test_nothing_changed(self):
        self.assertEqual(self.changes(_h2mc.SCENE), [])

    def test_changes(self):
        for name, (old, new, line) in CHANGES.items():
            with self.subTest(name):
                self.assertIn(old, _h2mc.SCENE)
                lines = self.changes(_h2mc.SCENE.replace(old, new, 1))
                self.assertTrue(any(line in l for l in lines), lines)
                self.assertTrue(all(re.match(r"scene\.xml:\d+:\d+: ", l) for l in lines), lines)

    def test_picture_filter(self):
        self.write_png("a.png", 4, 4, lambda x, y: (9, 9, 9))
        picture = ('<bsdf type="diffuse" id="grey"><texture type="bitmap" name="reflectance">'
                   '<string name="filename" value="a.png"/><string name="filterType" value="{}"/></texture></bsdf>')
        self.assertEqual(self.changes(_h2mc.SCENE.replace(GREY, picture.format("bilinear"))), [])
        [line] = self.changes(_h2mc.SCENE.replace(GREY, picture.format("ewa")))
        self.assertIn('"filterType" of texture "bitmap": ewa in the file, used: bilinear', line)

    def test_radiance_near_floats_limit(self):
        """Renders or is refused: no infinite pixel, and integrators agree."""
        lamp = 'name="radiance" value="$radiance, $radiance, $radiance"'
        for value in ("1e-38", "1e37", "3e38"):
            for integrator in ("path", _h2mc.quick("h2mc")):
                with self.subTest(value=value, integrator=integrator):
                    self.write("scene.xml", _h2mc.SCENE.replace(lamp, f'name="radiance" value="{value}"'))
                    self.succeeds("render", "scene.xml", "-o", "out.exr", "-i", integrator, "-s", 64, "--stats",
                                  "stats.json")
                    statistics = self.report("stats.json")
                    self.assertEqual(statistics["statistics"]["not finite"], 0)
                    share = statistics["meanLuminance"] / float(value)
                    self.assertTrue(0.01 < share < 1, share)
        # A thousand lights in one place are brighter than any file can say.
        point = ('<emitter type="point"><point name="position" x="0" y="0.001" z="1"/>'
                 '<rgb name="intensity" value="3e38"/></emitter>')
        lamp = re.search(r'<emitter type="area">.*?</emitter>', _h2mc.SCENE).group(0)
        self.write("scene.xml", _h2mc.SCENE.replace(lamp, "").replace('<default name="radiance" value="4"/>', "")
                   .replace(END, 1000 * point + END))
        for integrator in ("path", _h2mc.quick("h2mc")):
            self.fails(2, "render", "scene.xml", "-q", "-o", "out.exr", "-i", integrator, "-s", 64,
                       says=("pixel (", "is too bright for an image file", "3.4e38"))


if __name__ == "__main__":
    _h2mc.main()
