#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc completion and h2mc man: what shells make of the scripts, and manual pages without a warning."""

import os
import re
import shutil
import subprocess
import unittest

import _h2mc

COMMANDS = ["render", "info", "list", "diff", "gradcheck", "stress", "compare", "demo", "inspect", "merge",
            "completion", "man", "convert", "rerender"]


def needs(*programs):
    missing = [program for program in programs if not shutil.which(program)]
    return unittest.skipIf(missing, f"no {', '.join(missing)}")


class Completion(_h2mc.Test):
    def setUp(self):
        super().setUp()
        for shell in ("bash", "zsh", "fish"):
            self.write(shell, self.succeeds("completion", shell).stdout)
        for name in ("a scene.xml", "b.xml", "c.exr", "quote's.xml"):
            self.write(name, "")
        os.mkdir(self.path("folder"))

    def options(self, *command):
        """Those that --help shows."""
        text = self.succeeds(*command, "--help").stdout
        found = set()
        for line in re.findall(r"(?m)^ {2,4}(-\S+)", text):
            found.update(line.split(","))
        return found

    def run_shell(self, *command):
        environment = dict(os.environ, PATH=os.path.dirname(_h2mc.BINARY) + ":" + os.environ["PATH"],
                           HOME=self.folder, LC_ALL="C.UTF-8")
        result = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, text=True, check=False,
                                timeout=60)
        self.assertEqual((result.returncode, result.stderr), (0, ""), command)
        return result.stdout

    def bash(self, *words):
        """What is offered for the last of the words."""
        script = ('source ./bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _h2mc; '
                  "printf '%s\\n' \"${COMPREPLY[@]}\"")
        return sorted(filter(None, self.run_shell("bash", "-c", script, "-", "h2mc", *words).splitlines()))

    def fish(self, line):
        text = self.run_shell("fish", "--no-config", "-c", f"source ./fish; complete -C '{line}'")
        return sorted(word.split("\t")[0] for word in text.splitlines())

    def zsh(self, line):
        """The words that the completion system has got, by a terminal of zsh's own."""
        script = r"""
zmodload zsh/zpty
zpty it 'zsh -f -i'
talk() { zpty -w it "$1"; zpty -r -m it answer "*$2*" >/dev/null }
talk 'PS1=; unsetopt zle_bracketed_paste; autoload -Uz compinit; compinit -u -D; source ./zsh; echo rea""dy' 'ready'
talk 'compadd() {
if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return; fi
local -a hits; builtin compadd -A hits "$@"; print -rl -- ${hits/#/hit:} >>hits
builtin compadd "$@" }; echo de""fined' 'defined'
talk 'bindkey "^X" complete-word; zle -C complete-word complete-word _main_complete; echo bo""und' 'bound'
zpty -w -n it "$1"$'\x18'
sleep 1
zpty -d it
"""
        self.write("hits", "")
        self.run_shell("zsh", "-f", "-c", script, "-", line)
        with open(self.path("hits"), encoding="utf-8") as hits:
            return sorted({hit[4:].rstrip("\n") for hit in hits if hit.startswith("hit:")})

    @needs("bash")
    def test_bash(self):
        self.assertEqual(self.bash(""), sorted(COMMANDS))
        self.assertEqual(self.bash("ren"), ["render"])
        self.assertEqual(self.bash("demo", ""), ["image-copy"])
        self.assertEqual(self.bash("--v"), ["--version"])
        for command in [*([name] for name in COMMANDS), ["demo", "image-copy"]]:
            self.assertEqual(set(self.bash(*command, "-")), self.options(*command), command)
        self.assertEqual(self.bash("render", "x.xml", "--sa"), ["--samples-per-pixel", "--save-every"])
        # Integrators and presets, as `h2mc list` has them.
        names = self.bash("render", "x.xml", "-i", "")
        listed = re.findall(r"(?m)^  (\S+)$", self.succeeds("list", "integrators").stdout)
        self.assertLessEqual({*listed, *_h2mc.INTEGRATORS, "h2mc-2015"}, set(names))
        self.assertEqual(self.bash("render", "--integrator", "=", "mm"), ["mmlt", "mmlt-2014"])
        self.assertEqual(self.bash("render", "--integrator", "="), names)
        self.assertEqual(self.bash("inspect", "-i", "h"), self.bash("render", "-i", "h"))
        self.assertEqual(self.bash("render", "-i", "mmlt", ":", "max"), [])
        # Files: scenes, folders, any.
        self.assertEqual(self.bash("render", ""), ["a scene.xml", "b.xml", "folder", "quote's.xml"])
        self.assertEqual(self.bash("render", "b"), ["b.xml"])
        self.assertEqual(self.bash("diff", "c"), ["c.exr"])
        self.assertEqual(self.bash("render", "b.xml", "-o", "c"), ["c.exr"])
        self.assertEqual(self.bash("render", "b.xml", "--confine", ""), ["folder"])
        self.assertEqual(self.bash("render", "b.xml", "--seed", ""), [])
        # One of several words.
        self.assertEqual(self.bash("diff", "a", "b", "--picture", ""), ["relative", "signed"])
        self.assertIn("relmse-trimmed", self.bash("diff", "a", "b", "--metric", ""))
        self.assertEqual(self.bash("completion", ""), ["bash", "fish", "zsh"])
        self.assertIn("mutations", self.bash("list", ""))

    @needs("fish")
    def test_fish(self):
        self.run_shell("fish", "--no-execute", "fish")
        self.assertEqual(self.fish("h2mc "), sorted(COMMANDS))
        self.assertEqual(self.fish("h2mc demo "), ["image-copy"])
        self.assertLessEqual({"--integrator", "--time", "--seed"}, set(self.fish("h2mc render x.xml --")))
        self.assertNotIn("--metric", self.fish("h2mc render x.xml --"))
        self.assertEqual(self.fish("h2mc render x.xml -i mm"), ["mmlt", "mmlt-2014"])
        self.assertEqual(self.fish("h2mc diff a b --picture "), ["relative", "signed"])
        self.assertIn("b.xml", self.fish("h2mc render "))
        self.assertEqual(self.fish("h2mc diff c"), ["c.exr"])
        self.assertEqual(self.fish("h2mc render x.xml --confine "), ["folder/"])

    @needs("zsh")
    def test_zsh(self):
        self.run_shell("zsh", "-f", "-n", "zsh")
        self.assertEqual(self.zsh("h2mc "), sorted(COMMANDS))
        self.assertEqual(self.zsh("h2mc demo "), ["image-copy"])
        self.assertLessEqual({"--integrator", "--time", "--seed"}, set(self.zsh("h2mc render x.xml --")))
        self.assertEqual(self.zsh("h2mc render x.xml -i mm"), ["mmlt", "mmlt-2014"])
        self.assertEqual(self.zsh("h2mc diff a b --picture "), ["relative", "signed"])
        self.assertEqual(self.zsh("h2mc render b"), ["b.xml"])

    def test_input(self):
        self.fails(2, "completion", says="SHELL")
        self.fails(2, "completion", "tcsh", says=("tcsh", "bash"))


class Man(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.succeeds("man", "-o", "pages")
        self.pages = sorted(os.listdir(self.path("pages")))

    def test_pages(self):
        self.assertEqual(self.pages, sorted(["h2mc.1", "h2mc-demo-image-copy.1", *(f"h2mc-{c}.1" for c in COMMANDS)]))
        for command in ([], ["render"], ["demo", "image-copy"]):
            with open(self.path("-".join(["pages/h2mc", *command]) + ".1"), encoding="utf-8") as page:
                self.assertEqual(page.read(), self.succeeds("man", *command).stdout)
        text = self.succeeds("man", "render").stdout
        self.assertIn("\\fB\\-i\\fR, \\fB\\-\\-integrator\\fR \\fIINTEGRATOR\\fR", text)
        for name in re.findall(r"(?m)^ {2,4}(?:-\w,)?--([a-z-]+)", self.succeeds("render", "--help").stdout):
            self.assertIn("\\-\\-" + name.replace("-", "\\-"), text)
        self.assertIn("signed|relative", self.succeeds("man", "diff").stdout)
        self.assertIn("From 8 to 1024. Default: 128.", self.succeeds("man", "demo", "image-copy").stdout)

    @needs("groff")
    def test_no_warnings(self):
        for page in self.pages:
            result = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z", self.path("pages/" + page)],
                                    capture_output=True, text=True, check=False)
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""), page)

    @needs("man")
    def test_as_it_is_read(self):
        environment = dict(os.environ, MANWIDTH="100", LC_ALL="C.UTF-8", MAN_KEEP_FORMATTING="")
        for page in self.pages:
            result = subprocess.run(["man", "--warnings", "-l", self.path("pages/" + page)], env=environment,
                                    capture_output=True, text=True, check=False)
            self.assertEqual((result.returncode, result.stderr), (0, ""), page)
            self.assertIn("SYNOPSIS", result.stdout)
            # Nothing was taken for a request or an escape: what the help says is there.
            command = page[:-2].split("-", 1)[1:]
            command = ["demo", "image-copy"] if command == ["demo-image-copy"] else command
            shown = re.sub(r"\s+", " ", result.stdout.replace("‐", "-"))
            for example in re.findall(r"(?m)^  (h2mc .*)$", self.succeeds(*command, "--help").stdout):
                self.assertIn(re.sub(r"\s+", " ", example), shown, page)

    def test_input(self):
        self.fails(2, "man", "rendr", says=("rendr", 'did you mean "render"'))
        self.fails(2, "man", "render", "-o", "pages", says="-o writes the pages of all")
        self.write("file", "")
        self.fails(2, "man", "-o", "file", says="file")


if __name__ == "__main__":
    _h2mc.main()
