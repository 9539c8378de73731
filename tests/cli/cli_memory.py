#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A render that needs more memory than there is: exit code 2 at once, with the figures and the option that decides."""


import _h2mc



class Memory(_h2mc.Test):
    def refused(self, *arguments, says):
        self.refuses_at_once(*arguments, says=says, megabytes=400)
        self.assertNotIn("out.exr", self.files())

    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)

    def test_chains(self):
        for method in _h2mc.CHAINS:
            self.refused("render", "scene.xml", "-q", "-o", "out.exr", "-i", f"{method}:chains=1000000000",
                         says=["for 1000000000 chains", "expected fewer", '"chains"', "--max-memory GB"])

    def test_bootstrap(self):
        self.refused("render", "scene.xml", "-q", "-o", "out.exr", "-i", "h2mc:bootstrapSamples=2000000000",
                     "--max-memory", 10, says=["16 GB for 2000000000 bootstrap samples", '"bootstrapSamples"',
                           "larger --max-memory"])

    def test_pixels(self):
        size = ["--width", 200000, "--height", 200000]
        for integrator in _h2mc.INTEGRATORS:
            self.refused("render", "scene.xml", "-q", "-o", "out.exr", "-i", integrator, *size,
                         says=["200000 x 200000 pixels", "at most 65536"])
            self.refused("render", "scene.xml", "-q", "-o", "out.exr", "-i", integrator, "--width", 16000,
                         "--height", 16000, "--max-memory", 5,
                         says=["films and images of 16000 x 16000 pixels", "a smaller width or height"])

    def test_other_commands(self):
        self.refused("compare", "scene.xml", "-q", "-o", "out", "-i", "path", "-m", 1, "--repeats", 1, "--width", 8000,
                     "--height", 8000, "--max-memory", 1, says=["8000 x 8000 pixels"])

    def test_what_there_is_room_for_renders(self):
        for integrator in _h2mc.INTEGRATORS:
            self.succeeds("render", "scene.xml", "-q", "-o", f"{integrator}.exr", "-i", _h2mc.quick(integrator), "-s",
                          2, "--max-memory", 0.2)
        self.refused("render", "scene.xml", "-q", "-o", "out.exr", "-i", "path", "-s", 1, "--width", 1920,
                     "--height", 1080, "--max-memory", 0.05, says=["1920 x 1080"])
        self.succeeds("render", "scene.xml", "-q", "-o", "big.exr", "-i", "path", "-s", 1, "--width", 1920,
                      "--height", 1080, "--max-memory", 0.3)


if __name__ == "__main__":
    _h2mc.main()
