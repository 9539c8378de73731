#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Scenes in which things move, as a user sees them."""

import _h2mc

SHUTTER = '<float name="shutterClose" value="1"/>'
ROLL = """<animation name="toWorld"><transform time="0"><translate x="-0.8"/></transform>
  <transform time="1"><rotate z="1" angle="-90"/><translate x="0.8"/></transform></animation>"""
SWEEP = """<animation name="toWorld">
  <transform time="0"><lookat origin="0, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform>
  <transform time="1"><lookat origin="0.5, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform>
</animation>"""
STILL = '<transform name="toWorld"><lookat origin="0, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform>'


def scene(shutter="", ball="", camera=STILL):
    text = _h2mc.SCENE.replace('<float name="fov" value="40"/>',
                               '<float name="fov" value="40"/>' + shutter)
    text = text.replace('<point name="center" x="0" y="0.5" z="0"/>', ball)
    assert STILL in text
    return text.replace(STILL, camera)


class Motion(_h2mc.Test):
    def info(self, text):
        return self.succeeds("info", self.write("scene.xml", text)).stdout

    def test_info(self):
        self.assertRegex(self.info(scene()), r"(?m)^moving +no$")
        text = self.info(scene(SHUTTER, ROLL))
        self.assertRegex(text, r"shapes +4 \(1 moving sphere, 3 triangle mesh\)")
        self.assertRegex(text, r"(?m)^shutter +0 to 1$")
        self.assertRegex(text, r"(?m)^moving +1 shape \(1 in \d+ steps\)$")
        self.assertRegex(self.info(scene(SHUTTER, ROLL, SWEEP)),
                         r"(?m)^moving +1 shape \(1 in \d+ steps\), the camera$")

    def test_closed_shutter_is_told(self):
        text = self.info(scene("", ROLL))
        self.assertRegex(text, r"(?m)^moving +no$")
        self.assertRegex(text, r"(?m)^note .*shutter")

    def test_all_integrators_blur(self):
        self.write("moving.xml", scene(SHUTTER, ROLL))
        self.write("still.xml", scene("", ROLL))
        for name in _h2mc.INTEGRATORS:
            for which in ("moving", "still"):
                self.succeeds("render", which + ".xml", "-i", _h2mc.quick(name, "maxDepth=3"),
                              "--samples-per-pixel", 40, "-o", which + ".exr", "--quiet")
            # Another picture, but not much darker or brighter.
            out = self.succeeds("diff", "moving.exr", "still.exr").stdout
            values = {line.split()[0]: float(line.split()[1]) for line in out.splitlines() if line}
            self.assertAlmostEqual(values["mean-ratio"], 1, delta=0.1, msg=name)
            self.assertGreater(values["relmse"], 0.005, name)

    def test_same_for_any_number_of_threads(self):
        self.write("moving.xml", scene(SHUTTER, ROLL, SWEEP))
        for name in ("bdpt", "h2mc"):
            pixels = []
            for threads in (1, 2):
                self.succeeds("render", "moving.xml", "-i", _h2mc.quick(name, "maxDepth=3"),
                              "--samples-per-pixel", 4, "-o", "out.exr", "--quiet",
                              "--threads", threads)
                pixels.append(self.read_exr("out.exr")[1])
            self.assertEqual(pixels[0], pixels[1], name)

    def test_broken_motion(self):
        broken = ROLL.replace('time="1"', 'time="0"')
        self.fails(2, "render", self.write("scene.xml", scene(SHUTTER, broken)), "-o", "out.exr",
                   says=("scene.xml:", "a second keyframe at the same time", "^"))
        open_ = '<float name="shutterOpen" value="2"/>' + SHUTTER
        self.fails(2, "info", self.write("scene.xml", scene(open_, ROLL)),
                   says="the shutter closes before it opens")


if __name__ == "__main__":
    _h2mc.main()
