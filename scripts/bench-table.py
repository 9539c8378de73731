#!/usr/bin/env python3
"""The README's table of what paths cost, out of a run of the benchmarks.

    scripts/bench-table.py [--program build/release/tests/h2mc_bench] [--scenes torus,ring] [--json FILE]

Runs them (or reads the JSON of a run) and prints Markdown: nanoseconds of CPU time for one evaluation of
the contribution, and everything else as multiples of it, by scene and path length. Medians of several
repetitions, taken in turns, so that a machine that slows down hurts all alike.
"""
import argparse
import collections
import json
import pathlib
import statistics
import subprocess
import sys

# What is measured: name in the benchmarks, words in the table, what it is on top of.
ROWS = [
    ("derivative", "derivatives, vertex-local", None),
    ("plain derivative", "derivatives, plain", None),
    ("chosen derivative", "derivatives, as chains choose", None),
    ("derivative+gaussian", "Gaussian made of them", "chosen derivative"),
    ("sample+density", "sampling it, and its density", None),
    ("mutation:isotropic", "isotropic mutation", None),
    ("mutation:hamiltonian", "Hamiltonian mutation", None),
]


def run(program, scenes, repetitions):
    """Returns {benchmark: [nanoseconds]}."""
    times = collections.defaultdict(list)
    pattern = "^(" + "|".join(scenes) + ")/"
    for _ in range(repetitions):
        output = subprocess.run(
            [program, "--benchmark_format=json", f"--benchmark_filter={pattern}", "--benchmark_min_time=0.1"],
            check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
        collect(json.loads(output), times)
    return times


def collect(result, times):
    for benchmark in result["benchmarks"]:
        if benchmark.get("run_type") != "aggregate" and not benchmark.get("error_occurred"):
            times[benchmark["name"]].append(benchmark["cpu_time"])


def table(scene, times):
    def median(what, length):
        found = times.get(f"{scene}/{what}/length:{length}")
        return statistics.median(found) if found else None

    lengths = [n for n in range(1, 33) if median("value", n)]
    lines = ["| " + scene + ", edges | " + " | ".join(map(str, lengths)) + " |",
             "|---|" + "---|" * len(lengths),
             "| one evaluation, ns | " + " | ".join(f"{median('value', n):.0f}" for n in lengths) + " |"]
    for name, words, base in ROWS:
        cells = []
        for n in lengths:
            t = median(name, n)
            if t is not None and base:
                t -= median(base, n) or 0
            cells.append("" if t is None else f"{t / median('value', n):.1f}")
        if any(cells):
            lines.append(f"| {words} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(root / "build/release/tests/h2mc_bench"))
    parser.add_argument("--scenes", default="torus,ring,bathroom")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--json", help="a run's output, instead of running")
    options = parser.parse_args()
    scenes = options.scenes.split(",")
    if options.json:
        times = collections.defaultdict(list)
        collect(json.loads(pathlib.Path(options.json).read_text()), times)
    else:
        times = run(options.program, scenes, options.repetitions)
    tables = [table(scene, times) for scene in scenes if any(name.startswith(scene + "/") for name in times)]
    if not tables:
        sys.exit("bench-table: no benchmark of these scenes has run")
    print("\n\n".join(tables))


if __name__ == "__main__":
    main()
