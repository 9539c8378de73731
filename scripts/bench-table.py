#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The table of what paths cost in docs/measurements.md, out of a run of the benchmarks, and what has become slower.

    scripts/bench-table.py [--program build/release/tests/h2mc_bench] [--scenes torus,ring] [--json FILE]
    scripts/bench-table.py --compare [--baseline tests/bench/baseline.json] [--tolerance 0.15]
    scripts/bench-table.py --save

Runs them (or reads the JSON of a run) and prints Markdown: nanoseconds of CPU time for one evaluation of
the contribution, and everything else as multiples of it, by scene and path length. Medians of several
repetitions, taken in turns, so that a machine that slows down hurts all alike.

--save keeps these multiples as the baseline, and one evaluation as a multiple of a plain expression that runs beside
it.
--compare prints the table and each multiple that differs from the baseline's by more than the tolerance; exit code 1
where one is larger, that is, where something has become slower. Nothing absolute is compared: a slower machine is not a
slower program.
"""
import argparse
import collections
import datetime
import json
import pathlib
import platform
import re
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# The plain expression of tests/bench/ad_bench.cpp, which no change to the renderer touches.
PLAIN = "expression<float>"

# What is measured: name in the benchmarks, words in the table, what it is on top of.
ROWS = [
    ("derivative", "derivatives, vertex-local", None),
    ("plain derivative", "derivatives, plain", None),
    ("chosen derivative", "derivatives, as chains choose", None),
    ("gradient", "the gradient alone", None),
    ("derivative+gaussian", "Gaussian made of them", "chosen derivative"),
    ("sample+density", "sampling it, and its density", None),
    ("mutation:isotropic", "isotropic mutation", None),
    ("mutation:hamiltonian", "Hamiltonian mutation", None),
    ("mutation:langevin", "Langevin mutation", None),
    ("path densities", "densities of all techniques", None),
    ("path densities+assemble", "those, and the path in another technique", None),
]


def run(program, scenes, repetitions):
    """Returns {benchmark: [nanoseconds]}."""
    times = collections.defaultdict(list)
    pattern = "^((" + "|".join(scenes) + ")/|" + re.escape(PLAIN) + ")"
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


def ratios(scenes, times):
    """Returns {scene/what/length: multiple of one evaluation}, for "value" itself of the plain expression."""
    medians = {name: statistics.median(values) for name, values in times.items()}
    plain = next((time for name, time in medians.items() if name.startswith(PLAIN)), None)
    result = {}
    for name, time in sorted(medians.items()):
        scene, _, rest = name.partition("/")
        what, _, length = rest.partition("/")
        if scene not in scenes:
            continue
        unit = plain if what == "value" else medians.get(f"{scene}/value/{length}")
        if unit:
            result[name] = time / unit
    return result


def compare(baseline, now, tolerance):
    """Returns (lines that say what differs, whether something has become slower)."""
    lines, slower = [], 0
    for name, before in sorted(baseline.items()):
        if name not in now:
            continue
        change = now[name] / before
        if change > 1 + tolerance:
            slower += 1
        if not 1 / (1 + tolerance) <= change <= 1 + tolerance:
            lines.append(f"{'slower' if change > 1 else 'faster'}: {name}: {before:.2f} -> {now[name]:.2f} "
                         f"({100 * (change - 1):+.0f} %)")
    both = [now[name] / baseline[name] for name in baseline if name in now]
    if not both:
        sys.exit("bench-table: nothing that the baseline holds has been measured")
    lines.append(f"{len(both)} multiples compared, {slower} larger by more than {100 * tolerance:.0f} %; "
                 f"median change {100 * (statistics.median(both) - 1):+.1f} %")
    return lines, slower > 0


def commit():
    found = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short=10", "HEAD"], capture_output=True, text=True,
                           check=False)
    return found.stdout.strip() or "unknown"


def processor():
    try:
        names = re.findall(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    except OSError:
        names = []
    return names[0] if names else platform.processor() or platform.machine()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/tests/h2mc_bench"))
    parser.add_argument("--scenes", default="torus,ring,bathroom")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--json", help="a run's output, instead of running")
    parser.add_argument("--compare", action="store_true", help="with the baseline; exit code 1 if something is slower")
    parser.add_argument("--save", action="store_true", help="as the new baseline")
    parser.add_argument("--baseline", default=str(ROOT / "tests/bench/baseline.json"))
    parser.add_argument("--tolerance", type=float, default=0.15, help="relative (default: 0.15)")
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
    now = ratios(scenes, times)
    if options.compare:
        baseline = json.loads(pathlib.Path(options.baseline).read_text())["ratios"]
        lines, slower = compare(baseline, now, options.tolerance)
        print("\n" + "\n".join(lines))
        if slower:
            sys.exit(1)
    if options.save:
        made = {"commit": commit(), "date": datetime.date.today().isoformat(), "machine": processor(),
                "repetitions": options.repetitions,
                "ratios": {name: float(f"{ratio:.3g}") for name, ratio in now.items()}}
        pathlib.Path(options.baseline).write_text(json.dumps(made, indent=1) + "\n")


if __name__ == "__main__":
    main()
