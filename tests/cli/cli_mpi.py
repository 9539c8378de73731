#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders by several processes, on this machine."""

import glob
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

import _h2mc

MPIRUN = shutil.which("mpirun")
MODULE = glob.glob(os.path.join(os.path.dirname(_h2mc.BINARY), "modules", "libh2mc_mpi.so"))
# All on this machine, whoever runs the tests, on whatever cores there are.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_hwloc_base_binding_policy="none",
                   OMPI_MCA_plm_rsh_agent="false")


class Mpi(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)

    def start(self, ranks, *arguments, options=()):
        command = [MPIRUN, *options, "-n", str(ranks), _h2mc.BINARY, *map(str, arguments)]
        process = subprocess.Popen(command, cwd=self.folder, env=ENVIRONMENT, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        return process

    def by_ranks(self, ranks, *arguments, code=0):
        """What they say, on stderr."""
        process = self.start(ranks, *arguments)
        _, messages = process.communicate(timeout=300)
        self.assertEqual(process.returncode, code, messages)
        return messages

    def ranks_of(self, process, count, seconds=60):
        """Process numbers in the ranks' order, once all of them are ready for a signal."""
        found = {}
        end = time.monotonic() + seconds
        while len(found) < count and time.monotonic() < end and process.poll() is None:
            for folder in pathlib.Path("/proc").glob("[0-9]*"):
                try:
                    status = (folder / "status").read_text(encoding="ascii", errors="replace")
                    if f"PPid:\t{process.pid}\n" not in status or "Name:\th2mc\n" not in status:
                        continue
                    caught = int(re.search(r"^SigCgt:\s*([0-9a-f]+)", status, re.MULTILINE).group(1), 16)
                    variables = (folder / "environ").read_bytes().decode(errors="replace")
                except OSError:
                    continue
                if caught >> (signal.SIGUSR1 - 1) & 1:
                    found[int(re.search(r"OMPI_COMM_WORLD_RANK=(\d+)", variables).group(1))] = int(folder.name)
            time.sleep(0.05)
        self.assertEqual(sorted(found), list(range(count)), "the ranks do not begin")
        return [found[rank] for rank in range(count)]

    def wait_for(self, name, seconds=60):
        end = time.monotonic() + seconds
        while not os.path.exists(self.path(name)) and time.monotonic() < end:
            time.sleep(0.05)
        self.assertIn(name, self.files())

    def render(self, integrator, budget, *more):
        return ["render", "scene.xml", "--threads", 1, "-i", _h2mc.quick(integrator),
                "-s" if integrator in _h2mc.SAMPLERS else "-m", budget, *more]

    # The same image by one process and by any number of ranks: with epochs, replicas, layers of variances and counts.
    def test_number_of_ranks_does_not_matter(self):
        for integrator in ("h2mc", "mmlt", "lmc", "remlt", *_h2mc.SAMPLERS, "erpt", "restore"):
            layers = ("--aov", "variance,mutations,normal")
            with self.subTest(integrator):
                self.succeeds(*self.render(integrator, 40, "-o", "one.exr", *layers))
                for ranks in (1, 2, 4) if integrator in ("h2mc", "mmlt") else (3,):
                    messages = self.by_ranks(ranks, *self.render(integrator, 40, "-o", "ranks.exr", *layers))
                    self.assertEqual(self.picture("ranks.exr"), self.picture("one.exr"), f"{ranks} ranks")
                    self.assertEqual(messages.count("ranks.exr: "), 1)
        self.assertEqual(self.files(), ["one.exr", "ranks.exr", "scene.xml"])

    # What is told of the chains is that of all of them.
    def test_statistics(self):
        self.succeeds(*self.render("h2mc", 40, "-q", "-o", "one.exr", "--stats", "one.json"))
        self.by_ranks(2, *self.render("h2mc", 40, "-q", "-o", "two.exr", "--stats", "two.json"))
        one, two = self.report("one.json"), self.report("two.json")
        self.assertEqual(two["ranks"], 2)
        for name in ("mutation kinds", "octaves", "bootstrap", "large steps", "base samples", "epochs", "noise",
                     "chains that never moved", "not finite"):
            if name in one["statistics"]:
                self.assertEqual(two["statistics"][name], one["statistics"][name], name)

    def test_time(self):
        self.by_ranks(2, "render", "scene.xml", "--threads", 1, "-i", "h2mc", "--time", 2, "-o", "a.exr")
        header = self.picture("a.exr")[0]
        self.assertGreater(header["samples"], 1000)

    def test_checkpoints_are_for_any_number_of_ranks(self):
        keep = ("-o", "a.exr", "--checkpoint", "a.state", "--every", 0.2)
        process = self.start(3, *self.render("h2mc", 3000, *keep))
        self.ranks_of(process, 3)
        self.wait_for("a.state")
        process.send_signal(signal.SIGUSR1)  # mpirun hands it on
        _, messages = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, messages)
        self.assertIn('--resume goes on from "a.state"', messages)
        self.by_ranks(2, *self.render("h2mc", 3000, *keep, "--resume"))
        self.succeeds(*self.render("h2mc", 3000, "-o", "b.exr"))
        self.assertEqual(self.picture("a.exr"), self.picture("b.exr"))

    def samples_so_far(self, image):
        return self.picture(image)[0]["samples"] if os.path.exists(self.path(image)) else 0

    # The others write what there is. mpirun kills them soon after it has asked them to end, so that they have the more
    # time for it the more it is told to give them.
    def test_a_rank_is_killed(self):
        for integrator, killed in (("h2mc", 1), ("path", 2), ("erpt", 1)):
            with self.subTest(integrator):
                image, state = f"{integrator}.exr", f"{integrator}.state"
                render = self.render(integrator, 1000000, "-o", image, "--checkpoint", state, "--every", 0.2,
                                     "--save-every", 0.2)
                process = self.start(3, *render, options=("--mca", "odls_base_sigkill_timeout", "5"))
                ranks = self.ranks_of(process, 3)
                end = time.monotonic() + 60
                while time.monotonic() < end and not (self.samples_so_far(image) and state in self.files()):
                    time.sleep(0.1)
                before = self.samples_so_far(image)
                os.kill(ranks[killed], signal.SIGKILL)
                _, messages = process.communicate(timeout=60)
                self.assertNotEqual(process.returncode, 0)
                self.assertIn("a rank does not answer any more: the image holds what there was by then", messages)
                self.assertEqual(messages.count("(interrupted)"), 1, messages)
                header = self.picture(image)[0]
                self.assertGreaterEqual(header["samples"], before)
                self.assertGreater(before, 0)
                whole = self.path("whole.exr")
                self.succeeds(*self.render(integrator, 200, "-o", whole))
                ratio = re.search(r"mean-ratio +(\S+)", self.succeeds("diff", image, whole).stdout)
                self.assertAlmostEqual(float(ratio.group(1)), 1, delta=0.2)
                end = time.monotonic() + 10
                while any(os.path.exists(f"/proc/{rank}") for rank in ranks) and time.monotonic() < end:
                    time.sleep(0.1)
                self.assertFalse([rank for rank in ranks if os.path.exists(f"/proc/{rank}")])

    # Whatever is wrong is said once.
    def test_mistakes(self):
        for arguments, words in (
                (self.render("h2mc", 4, "-o", "a.exr", "--nonsense"), "--nonsense"),
                (self.render("nothing", 4, "-o", "a.exr"), "nothing"),
                (["render", "missing.xml", "-o", "a.exr"], "missing.xml"),
                (self.render("path", 4, "-o", "nowhere/a.exr"), "nowhere"),
                (self.render("path", 4, "-o", "a.exr", "--serve", 0), "--serve"),
                (["diff", "a.exr", "b.exr"], '"diff" is for one alone')):
            messages = self.by_ranks(3, *arguments, code=2)
            self.assertEqual(len(re.findall("^h2mc: ", messages, re.MULTILINE)), 1, messages)
            self.assertIn(words, messages)
        # What only one of them sees.
        self.write("other.xml", _h2mc.SCENE.replace("0.5, 0.5, 0.5", "0.6, 0.5, 0.5"))
        for other, code, words in (("other.xml", 2, "rank 1 has another program, scene or checkpoint than rank 0"),
                                   ("missing.xml", 2,
                                    "rank 1: missing.xml: error: cannot read the scene: no such file")):
            messages = self.by_ranks(1, "render", "scene.xml", "-m", 8, "-o", "a.exr", ":", "-n", 1, _h2mc.BINARY,
                                     "render", other, "-m", 8, "-o", "a.exr", code=code)
            self.assertEqual(re.findall("^h2mc: (.*)", messages, re.MULTILINE), [words], messages)
        self.assertEqual(self.files(), ["other.xml", "scene.xml"])


if __name__ == "__main__":
    if not MPIRUN or not MODULE:
        print("No renders by several ranks were tried: there is no", "module for MPI" if MPIRUN else "mpirun",
              file=sys.stderr)
        sys.exit(77)
    _h2mc.main()
