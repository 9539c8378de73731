#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc render: memory and time of large pictures, whatever the number of threads."""

import os
import subprocess
import time

import _h2mc

MB = 1 << 20


class Memory(_h2mc.Test):
    def peak(self, *arguments):
        """Most memory, in bytes, that the program held."""
        process = subprocess.Popen([_h2mc.BINARY, *map(str, arguments)], cwd=self.folder,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0, arguments)
        return usage.ru_maxrss * 1024

    def render(self, integrator, *arguments, size=(1920, 1080), threads=2):
        return self.peak("render", _h2mc.RING, "-q", "-o", "a.exr", "-i", integrator, "--width", size[0],
                         "--height", size[1], "--threads", threads, *arguments)

    def test_full_hd(self):
        """Below 200 MB."""
        for integrator in _h2mc.INTEGRATORS:
            with self.subTest(integrator):
                self.assertLess(self.render(integrator, "-m", 1), 200e6)

    def test_grows_with_the_picture_only(self):
        libraries = self.peak("list", "integrators")
        self.assertLess(libraries, 40 * MB)  # the image library, which would take 130 more, is not loaded
        for integrator, pixel in (("path", 48), ("h2mc:maxDepth=3", 72)):
            with self.subTest(integrator):
                small = self.render(integrator, "-m", 1, size=(16, 12))
                self.assertLess(small, libraries + 60 * MB)
                few, many = (self.render(integrator, "-m", 1, size=(960, 540), threads=threads)
                             for threads in (1, 32))
                # What an allocator keeps for each thread.
                self.assertLess(many, few + 32 * 2 * MB)
                large = self.render(integrator, "--time", 1, size=(3840, 2160))
                self.assertLess(large, small + 40 * MB + pixel * 3840 * 2160)

    def test_time_is_kept(self):
        """A picture of which not even one pass can be made: not much later than asked, whatever else runs."""
        for integrator in ("path", "h2mc"):
            with self.subTest(integrator):
                begin = time.monotonic()
                self.render(integrator, "--time", 2, "--stats", "a.json", size=(3840, 2160))
                # A pass of all pixels takes several times as long. Reading, making room and writing are not counted.
                # Processor time of the two threads: it says what was done however busy the machine is.
                self.assertLess(self.report("a.json")["cpuSeconds"], 8)
                self.assertLess(time.monotonic() - begin, 20)


if __name__ == "__main__":
    _h2mc.main()
