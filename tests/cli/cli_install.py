#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cmake --install: the program runs where it was put, and what its pages link to is there."""

import glob
import os
import re
import shutil
import subprocess
import sys

import _h2mc


class Install(_h2mc.Test):
    def setUp(self):
        super().setUp()
        if not shutil.which("cmake"):
            self.skipTest("no cmake")
        build = os.path.dirname(_h2mc.BINARY)
        self.installed = subprocess.run(["cmake", "--install", build, "--prefix", self.path("x")],
                                        capture_output=True, text=True, check=False)

    def test_what_is_installed(self):
        self.assertEqual(self.installed.returncode, 0, self.installed.stderr)
        program = self.path("x/bin/h2mc")
        result = subprocess.run([program, "--version"], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, self.succeeds("--version").stdout)

        share = self.path("x/share/h2mc")
        for name in ("README.md", "LICENSE", "CHANGELOG.md", "CITATION.cff", "docs/scene-format.md"):
            self.assertTrue(os.path.exists(os.path.join(share, name)), name)
        scenes = glob.glob(os.path.join(share, "scenes", "*", "*.xml"))
        self.assertGreater(len(scenes), 5)
        result = subprocess.run([program, "info", os.path.join(share, "scenes/ring/ring.xml")],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)

        # What the shells and man look for is what the program prints.
        for name, command in (("bash-completion/completions/h2mc", ["completion", "bash"]),
                              ("zsh/site-functions/_h2mc", ["completion", "zsh"]),
                              ("fish/vendor_completions.d/h2mc.fish", ["completion", "fish"]),
                              ("man/man1/h2mc.1", ["man"]), ("man/man1/h2mc-render.1", ["man", "render"])):
            with open(self.path("x/share/" + name), encoding="utf-8") as stream:
                self.assertEqual(stream.read(), self.succeeds(*command).stdout, name)

        # Its module for image files is found beside it, and missed with a message.
        picture = self.path("a.png")
        arguments = [program, "render", os.path.join(share, "scenes/ring/ring.xml"), "-q", "-o", picture, "-m", "1",
                     "-i", "path", "--width", "8", "--height", "6"]
        result = subprocess.run(arguments, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        for module in glob.glob(self.path("x/lib*/**/libh2mc_oiio.so"), recursive=True):
            os.remove(module)
        result = subprocess.run([program, "diff", picture, picture], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, "the module for image files does not load: libh2mc_oiio.so: ")

        broken = []
        for page in [os.path.join(share, "README.md"), *glob.glob(os.path.join(share, "docs", "*.md"))]:
            with open(page, encoding="utf-8") as stream:
                for link in re.findall(r"\]\(([^)#\s]+)", stream.read()):
                    if not re.match(r"[a-z]+:", link):
                        if not os.path.exists(os.path.join(os.path.dirname(page), link)):
                            broken.append(f"{os.path.relpath(page, share)}: {link}")
        self.assertEqual(broken, [])
        leftovers = [f for f in glob.glob(os.path.join(share, "**", "*"), recursive=True) if "__pycache__" in f]
        self.assertEqual(leftovers, [])

    def test_no_package_for_this_processor_alone(self):
        """scripts/package.sh --try tries packages as such: they take a build of their own."""
        if not shutil.which("cpack"):
            self.skipTest("no cpack")
        build = os.path.dirname(_h2mc.BINARY)
        with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as stream:
            text = stream.read()
        if "H2MC_NATIVE:BOOL=ON" not in text and "CMAKE_BUILD_TYPE:STRING=Rel" in text:
            self.skipTest("a build that packages may be made of")
        result = subprocess.run(["cpack", "-G", "DEB", "--config", os.path.join(build, "CPackConfig.cmake"),
                                 "-B", self.path("package")], capture_output=True, text=True, check=False)
        self.assertNotEqual(result.returncode, 0)
        self.assertRegex(result.stderr, r"(?s)no package of this build.*scripts/package\.sh")


if __name__ == "__main__":
    if sys.platform != "linux":
        sys.exit(77)
    _h2mc.main()
