#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""docs/tutorial.md, word by word: its files are written, its commands typed, in its order and in one folder."""

import os
import re
import shlex
import subprocess
import sys

import _h2mc

PAGE = os.path.join(_h2mc.SOURCE_DIR, "docs", "tutorial.md")


def steps(text):
    """("file", name, content) and ("command", words), as they come. A file's name is the last one in backquotes before
    it, in a paragraph that ends with a colon."""
    found, name = [], None
    for match in re.finditer(r"(?ms)^( *)```(\w+)\n(.*?)^ *```|`([\w.-]+)`[^`]*?:$", text):
        indent, kind, content, said = match.groups()
        if said:
            name = said
        elif kind == "console":
            found += [("command", shlex.split(line)) for line in content.splitlines()]
        else:
            found.append(("file", name, re.sub(rf"(?m)^{indent}", "", content)))
    return found


class Tutorial(_h2mc.Test):
    def test_word_by_word(self):
        with open(PAGE, encoding="utf-8") as stream:
            todo = steps(stream.read())
        names = [step[1] for step in todo if step[0] == "file"]
        self.assertEqual(names, ["vase.py", "vase.xml", "lit.xml", "spin.xml"])
        commands = 0
        for kind, what, *content in todo:
            if kind == "file":
                self.write(what, content[0])
                continue
            commands += 1
            program = {"h2mc": _h2mc.BINARY, "python3": sys.executable}[what[0]]
            result = subprocess.run([program, *what[1:]], cwd=self.folder, capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 0, f"{shlex.join(what)}: {result.stderr}")
            self.assertNotIn("warn", result.stderr.lower(), shlex.join(what))
            if what[1:2] == ["info"]:
                for words in ("12,290", "roughconductor", "320 x 240"):
                    self.assertIn(words, result.stdout)
        self.assertGreater(commands, 9)
        for name in ("vase.obj", "vase.exr", "vase.png", "gold.png", "brighter.png", "by-path.png", "lit.png",
                     "spin.png", "variance.png", "vase.json", "compared/index.html", "inspected/index.html"):
            self.assertGreater(os.path.getsize(self.path(name)), 100, name)
        # What the page says of the pictures: the two methods agree, and the same time gives less noise by chains.
        result = self.succeeds("diff", "vase.exr", "by-path.exr")
        ratio = float(re.search(r"mean-ratio +(\S+)", result.stdout).group(1))
        self.assertAlmostEqual(ratio, 1, delta=0.1)

    def test_the_page_is_taken_apart(self):
        text = "One. `a.b`:\n\n```xml\n<x/>\n```\n\n1. two\n\n   ```console\n   h2mc x 'y z'\n   ```\n"
        self.assertEqual(steps(text),
                         [("file", "a.b", "<x/>\n"), ("command", ["h2mc", "x", "y z"])])


if __name__ == "__main__":
    _h2mc.main()
