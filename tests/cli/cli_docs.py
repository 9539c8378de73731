#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""README, CONTRIBUTING, docs/*.md and the scenes' READMEs: links and paths lead somewhere, commands are understood,
generated parts are current."""

import functools
import glob
import os
import re
import subprocess
import sys

import _h2mc

ROOT = os.path.abspath(_h2mc.SOURCE_DIR)
PAGES = sorted(glob.glob(os.path.join(ROOT, "*.md")) + glob.glob(os.path.join(ROOT, "docs", "**", "*.md"),
                                                                            recursive=True)
               + glob.glob(os.path.join(ROOT, "scenes", "*", "README.md")))
# Words that stand for a file's name or a choice: what holds them is no path.
PLACEHOLDER = re.compile(r"[A-Z]{3,}|\.\.\.|[*<>{}$ ]")


def read(path):
    with open(path, encoding="utf-8") as stream:
        return stream.read()


def code_lines(text):
    """The lines of indented blocks outside of lists, continued ones joined."""
    lines, in_item = [], False
    for line in text.splitlines():
        if re.match(r"\S", line):
            in_item = bool(re.match(r"[-*] |[0-9]+\. ", line))
        elif line.startswith("    ") and not in_item:
            lines.append(line.strip())
    return re.sub(r"\\\n\s*", " ", "\n".join(lines)).splitlines()


def anchors(text):
    """The names under which a page's headings can be linked to."""
    names = set()
    for heading in re.findall(r"(?m)^#+ +(.*)$", re.sub(r"(?ms)^```.*?^```", "", text)):
        heading = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")
        names.add(name if name not in names else name + "-1")
    return names


def links(text):
    text = re.sub(r"(?ms)^```.*?^```|`[^`\n]*`", "", text)
    found = re.findall(r"!?\[[^]]*\]\(([^)\s]+)\)", text) + re.findall(r'<img src="([^"]+)"', text)
    return found + re.findall(r"(?m)^\[[^]]+\]: +(\S+)", text)


@functools.lru_cache(maxsize=None)
def help_of(*command):
    result = subprocess.run([_h2mc.BINARY, *command, "--help"], capture_output=True, text=True, check=False)
    return result.stdout if result.returncode == 0 else ""


class Pages(_h2mc.Test):
    def test_mitsuba_s_plugins(self):
        """The page says of each plugin what the program says of it."""
        listed = set(re.findall(r"(?m)^### (\S+)", self.succeeds("list", "--markdown").stdout))
        seen = 0
        for line in read(os.path.join(ROOT, "docs", "mitsuba.md")).splitlines():
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            if len(cells) != 3 or not cells[0].startswith("`") or "<rgb>" in cells[0]:
                continue
            for name in re.findall(r"`([a-z_]+)`", cells[0]):
                if re.match("yes|no", cells[2]):
                    seen += 1
                    self.assertEqual(name in listed, cells[2].startswith("yes"), line)
        self.assertGreater(seen, 60)

    def test_links_lead_somewhere(self):
        broken, count = [], 0
        for page in PAGES:
            for link in links(read(page)):
                if re.match(r"[a-z]+:", link):
                    continue
                count += 1
                path, _, anchor = link.partition("#")
                target = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
                if not os.path.exists(target):
                    broken.append(f"{os.path.relpath(page, ROOT)}: {link}: no such file")
                elif anchor and target.endswith(".md") and anchor not in anchors(read(target)):
                    broken.append(f"{os.path.relpath(page, ROOT)}: {link}: no such heading")
        self.assertEqual(broken, [])
        self.assertGreater(count, 50, "links are not found any more")

    def test_paths_exist(self):
        """What stands in backquotes and begins with one of the repository's folders."""
        broken, count = [], 0
        for page in PAGES:
            if os.path.basename(page) == "CHANGELOG.md":  # tells of what was
                continue
            for path in re.findall(r"`((?:src|tests|scripts|scenes|cmake|docs)/[^`\s:]+)", read(page)):
                if PLACEHOLDER.search(path):
                    continue
                count += 1
                if not os.path.exists(os.path.join(ROOT, path)):
                    broken.append(f"{os.path.relpath(page, ROOT)}: {path}")
        self.assertEqual(broken, [])
        self.assertGreater(count, 20, "paths are not found any more")

    def test_commands_are_understood(self):
        """Each h2mc command and option that a block of code shows is one that --help knows, each scene is there."""
        wrong, count = [], 0
        for page in PAGES:
            for line in code_lines(read(page)):
                match = re.match(r"(?:\$ )?(?:h2mc|scripts/run\.sh|build/\w+/h2mc) (.*)", line.split(" | ")[0])
                if not match:
                    continue
                words = re.sub(r"\s#.*", "", match[1]).split()
                command = words[:2] if words[0] == "demo" else words[:1]
                known = help_of(*command)
                where = f"{os.path.relpath(page, ROOT)}: {line}"
                count += 1
                if not known:
                    wrong.append(f"{where}: no such command")
                for word in words[1:]:
                    option = re.match(r"(--?[A-Za-z][-a-z]*)", word)
                    if option and not re.search(rf"(?m)(^ +|,){option[1]}\b", known):
                        wrong.append(f"{where}: no option {option[1]}")
                    if word.startswith("scenes/") and not PLACEHOLDER.search(word):
                        if not os.path.exists(os.path.join(ROOT, word)):
                            wrong.append(f"{where}: no file {word}")
        self.assertEqual(wrong, [])
        self.assertGreater(count, 20, "commands are not found any more")

    def test_scene_format_is_current(self):
        page = read(os.path.join(ROOT, "docs", "scene-format.md"))
        parts = re.findall(r"(?ms)^<!-- begin: h2mc list --markdown -->\n(.*?)^<!-- end: h2mc list --markdown -->$",
                           page)
        self.assertEqual(len(parts), 1)
        self.assertEqual(parts[0].splitlines(), self.succeeds("list", "--markdown").stdout.splitlines(),
                         "h2mc list says something else; CONTRIBUTING.md has the command that renews the page")

    def test_figures_are_current(self):
        result = subprocess.run([sys.executable, os.path.join(ROOT, "scripts", "figures.py"), "--check"],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_the_checks_see_mistakes(self):
        self.assertEqual(links("[a](b.md#c) ![d](e.png)\n<img src=\"f.png\">\n[g]: h.md\n`[no](no)`"),
                         ["b.md#c", "e.png", "f.png", "h.md"])
        self.assertEqual(anchors("# One two\n## The `x-y`, (z)?\n"), {"one-two", "the-x-y-z"})
        self.assertEqual(code_lines("text\n\n    h2mc a \\\n        b\n\n- item\n  more\n\n      h2mc c\n"),
                         ["h2mc a  b"])
        self.assertEqual(help_of("no-such-command"), "")


if __name__ == "__main__":
    _h2mc.main()
