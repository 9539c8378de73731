#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Scenes made for other renderers: what is a warning, what an error, and how that is chosen."""

import unittest

import _h2mc

INTEGRATOR = '<integrator type="{}"><integer name="maxDepth" value="3"/></integrator></scene>'
LEFTOVER = ('<shape type="sphere"><boolean name="faceNormals" value="true"/><ref id="grey"/>'
            '</shape></scene>')


class ForeignScenes(_h2mc.Test):
    def scene(self, end, version="0.6.0"):
        text = _h2mc.SCENE.replace("</scene>", end).replace("0.6.0", version)
        return self.write("scene.xml", text)

    def integrator(self, *arguments):
        self.succeeds("render", "scene.xml", "-o", "out.exr", "--samples-per-pixel", 1, *arguments)
        return self.read_exr("out.exr")[0]

    def test_the_command_line_goes_before_an_unknown_integrator(self):
        self.scene(INTEGRATOR.format("my_integrator"))
        result = self.succeeds("render", "scene.xml", "-o", "out.exr", "-i", "path",
                               "--samples-per-pixel", 1)
        self.assertRegex(result.stderr, r'scene\.xml:\d+:\d+: warning: unknown integrator '
                                        r'"my_integrator"\n.*\n *\^\n.*-i NAME')
        attributes = self.read_exr("out.exr")[0]
        self.assertEqual(attributes["integrator"], "path")
        self.assertIn("maxDepth=3", attributes["integratorOptions"])

    def test_an_unknown_integrator_leaves_the_default(self):
        self.scene(INTEGRATOR.format("my_integrator"))
        result = self.succeeds("render", "scene.xml", "-o", "out.exr", "-m", 1, "-i",
                               ":bootstrapSamples=4000,chains=32")
        self.assertIn("warning:", result.stderr)
        self.assertEqual(self.read_exr("out.exr")[0]["integrator"], "h2mc")

    def test_direct_is_direct_light_by_whatever_renders_it(self):
        self.scene('<integrator type="direct"/></scene>')
        attributes = self.integrator()
        self.assertEqual(attributes["integrator"], "path")
        self.assertIn("maxDepth=2", attributes["integratorOptions"])
        self.assertIn("maxDepth=2", self.integrator("-i", "bdpt")["integratorOptions"])
        self.assertIn("maxDepth=-1", self.integrator("-i", "bdpt:maxDepth=-1")["integratorOptions"])

    def test_quiet_says_no_warnings(self):
        self.scene(LEFTOVER)
        result = self.succeeds("render", "scene.xml", "-o", "out.exr", "-q", "-i", "path",
                               "--samples-per-pixel", 1)
        self.assertEqual(result.stderr, "")

    def test_permissive_and_strict(self):
        self.scene(LEFTOVER)
        result = self.succeeds("info", "scene.xml")
        self.assertIn("warning: unknown parameter", result.stderr)
        self.assertNotIn("warning:", result.stdout)
        self.fails(2, "info", "scene.xml", "--strict", says="error: unknown parameter")
        self.fails(2, "info", "scene.xml", "--strict", "--permissive", says="--permissive")
        self.scene(LEFTOVER, "3.0.0")
        self.fails(2, "info", "scene.xml", says=("error: unknown parameter", "available:"))
        self.assertIn("warning:", self.succeeds("info", "scene.xml", "--permissive").stderr)
        for command in ("render", "info", "gradcheck", "stress", "inspect", "compare"):
            self.assertIn("--permissive", self.succeeds(command, "--help").stdout)

    def test_all_that_is_wrong_is_said_at_once(self):
        self.scene('<shape type="ball"/><shape type="sphere"><ref id="gray"/></shape>'
                   '<emitter type="sunset"/></scene>')
        result = self.fails(2, "render", "scene.xml", says=('"ball"', '"gray"', '"sunset"'))
        self.assertEqual(result.stderr.count("error:"), 3, result.stderr)


if __name__ == "__main__":
    _h2mc.main()
