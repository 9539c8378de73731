#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/bench-table.py: its table, and what it calls slower."""

import json
import os
import subprocess
import sys

import _h2mc

SCRIPT = os.path.join(_h2mc.SOURCE_DIR, "scripts", "bench-table.py")


class BenchTable(_h2mc.Test):
    def run_of(self, name, plain=10.0, value=100.0, derivative=500.0):
        """A run's JSON as Google Benchmark writes it."""
        times = {"expression<float>/iterations:500": plain, "ring/value/length:3": value,
                 "ring/derivative/length:3": derivative, "ring/plain derivative/length:3": 300.0 * value / 100}
        return self.write(name, json.dumps({"benchmarks": [{"name": n, "cpu_time": t, "run_type": "iteration"}
                                                           for n, t in times.items()]}))

    def table(self, run, *options):
        return subprocess.run([sys.executable, SCRIPT, "--scenes", "ring", "--json", self.path(run), "--baseline",
                               self.path("baseline.json"), *options], capture_output=True, text=True, check=False)

    def test_against_a_baseline(self):
        saved = self.table(self.run_of("before.json"), "--save")
        self.assertEqual(saved.returncode, 0, saved.stderr)
        self.assertIn("| derivatives, vertex-local | 5.0 |", saved.stdout)
        self.assertEqual(self.report("baseline.json")["ratios"],
                         {"ring/value/length:3": 10.0, "ring/derivative/length:3": 5.0,
                          "ring/plain derivative/length:3": 3.0})

        same = self.table(self.run_of("slow machine.json", 20, 200, 1000), "--compare")
        self.assertEqual(same.returncode, 0, same.stdout)
        self.assertIn("3 multiples compared, 0 larger", same.stdout)

        slower = self.table(self.run_of("slower.json", derivative=600), "--compare")
        self.assertEqual(slower.returncode, 1)
        self.assertIn("slower: ring/derivative/length:3: 5.00 -> 6.00 (+20 %)", slower.stdout)
        self.assertEqual(self.table("slower.json", "--compare", "--tolerance", "0.3").returncode, 0)

        value = self.table(self.run_of("value.json", value=150, derivative=750), "--compare")
        self.assertEqual(value.returncode, 1)
        self.assertIn("slower: ring/value/length:3: 10.00 -> 15.00", value.stdout)

        faster = self.table(self.run_of("faster.json", derivative=300), "--compare")
        self.assertEqual(faster.returncode, 0)
        self.assertIn("faster: ring/derivative/length:3: 5.00 -> 3.00", faster.stdout)

    def test_the_baseline_is_one(self):
        with open(os.path.join(_h2mc.SOURCE_DIR, "tests", "bench", "baseline.json"), encoding="utf-8") as stream:
            baseline = json.load(stream)
        self.assertGreater(len(baseline["ratios"]), 20)
        for part in ("commit", "date", "machine"):
            self.assertTrue(baseline[part])


if __name__ == "__main__":
    _h2mc.main()
