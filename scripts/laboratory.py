#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What a second of work is worth, and where the error comes from: renders of several methods, or of several programs,
by turns, each with the same seeds.

    scripts/laboratory.py --scene torus --scene ring --method mmlt --method h2mc --mutations 64
    scripts/laboratory.py --method h2mc --program OLD/h2mc --program build/release/h2mc --seconds 10

For each scene and column: CPU seconds of all threads, start-up included, times relMSE (as `h2mc diff` has it, less the
reference's own noise), of all pixels and without the worst 0.1, 1 and 10 %: geometric means over the seeds, and their
ratios to the first column, seed by seed, with 95 % intervals; then what a mutation costs and what it is worth, how the
noise of pixels is correlated, and which part of the error each source has. Needs Debian's python3-numpy.
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scenes"))
import exr  # noqa: E402

TRIMS = (0, 0.001, 0.01, 0.1)  # shares of the worst pixels that are left out
DISTANCES = (1, 2, 4, 8, 16)  # pixels, of the correlation
# Student's t, two-sided 95 %, by degrees of freedom.
STUDENT = (12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131)
LUMINANCE = numpy.array([0.212671, 0.715160, 0.072169])


def read_image(path):
    """Array (height, width, 3)."""
    _, width, height, planes = exr.read(path)
    return numpy.array(planes, dtype=float).reshape(3, height, width).transpose(1, 2, 0)


class Scene:
    """A scene file with its reference."""

    def __init__(self, name, width):
        self.name = name
        self.file = ROOT / "scenes" / name / f"{name}.xml" if "/" not in name else pathlib.Path(name)
        if not self.file.exists():
            sys.exit(f"expected a scene's name or file, not {name!r}")
        reference = self.file.parent / "reference.exr"
        if not reference.exists():
            sys.exit(f"{reference}: there is no such reference image")
        self.reference = read_image(reference)
        self.size = (self.reference.shape[1], self.reference.shape[0])
        if width and width != self.size[0]:
            sys.exit(f"{name}: its reference is {self.size[0]} pixels wide, not {width}")
        mean = (self.reference @ LUMINANCE).mean()
        self.scale = self.reference**2 + 0.01 * mean**2
        error = self.file.parent / "reference_stderr.exr"
        self.noise = read_image(error)**2 / self.scale if error.exists() else numpy.zeros_like(self.scale)

    def errors(self, image):
        """relMSE without the worst pixels, one for each of TRIMS; at least a hundredth of what it is with the
        reference's noise."""
        of_pixels = ((image - self.reference)**2 / self.scale).mean(axis=2).ravel()
        noise = self.noise.mean(axis=2).ravel()
        order = numpy.argsort(of_pixels)
        result = []
        for trim in TRIMS:
            kept = order[:len(order) - int(trim * len(order))]
            error = of_pixels[kept].mean()
            result.append(max(error - noise[kept].mean(), 0.01 * error))
        return result


def render(program, scene, method, options, seed, folder):
    """What one run is: its statistics and its image."""
    name = f"{scene.name.replace('/', '_')}-{abs(hash((program, method)))}-{seed}"
    image, report = folder / f"{name}.exr", folder / f"{name}.json"
    budget = ["--time", options.seconds] if options.seconds else ["-m", options.mutations]
    command = [program, "render", scene.file, "-i", method, "--width", scene.size[0], "--height", scene.size[1],
               *budget, "--seed", seed, "--threads", options.threads, "-q", "-o", image, "--stats", report]
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if result.returncode:
        sys.exit(f"{' '.join(str(word) for word in command)}\n{result.stderr}")
    stats = json.loads(report.read_text(encoding="utf-8"))
    pixels = read_image(image)
    image.unlink()
    report.unlink()
    return stats, pixels


def interval(values):
    """(mean, half the 95 % interval) of a sample."""
    n = len(values)
    if n < 2:
        return values[0], math.inf
    t = STUDENT[n - 2] if n - 2 < len(STUDENT) else 2.0
    return numpy.mean(values), t * numpy.std(values, ddof=1) / math.sqrt(n)


def geometric(values):
    return math.exp(numpy.mean(numpy.log(values)))


class Column:
    """All runs of a method by a program on a scene."""

    def __init__(self, label):
        self.label, self.runs, self.images = label, [], []

    def add(self, scene, seed, stats, image):
        self.images.append(image)
        mean = (scene.reference @ LUMINANCE).mean()
        self.runs.append({
            "seed": seed, "cpuSeconds": stats["cpuSeconds"], "wallSeconds": stats["wallSeconds"],
            "perPixel": stats["samples"] / (scene.size[0] * scene.size[1]), "relMSE": scene.errors(image),
            "meanRatio": (image @ LUMINANCE).mean() / mean, "statistics": stats["statistics"]})

    def products(self, trim):
        """CPU seconds times relMSE by seed."""
        return [run["cpuSeconds"] * run["relMSE"][trim] for run in self.runs]

    def of_runs(self, key):
        return [run[key] for run in self.runs]

    def correlation(self, scene):
        """Of the noise of pixels at some distances along rows, weighted as relMSE weighs it."""
        if len(self.images) < 2:
            return {}
        noise = (numpy.array(self.images) - numpy.mean(self.images, axis=0)) / numpy.sqrt(scene.scale)
        # A few pixels would decide all of it.
        limit = numpy.quantile(numpy.abs(noise), 0.999)
        noise = numpy.clip(noise, -limit, limit)
        noise -= noise.mean(axis=0)
        variance = (noise**2).mean()
        return {d: float((noise[:, :, d:] * noise[:, :, :-d]).mean() / variance)
                for d in DISTANCES if d < scene.size[0]}

    def bias(self, scene):
        """Share of the mean squared relative error that does not average out over the seeds."""
        n = len(self.images)
        if n < 2:
            return None
        error = numpy.mean([run["relMSE"][0] for run in self.runs])
        return (scene.errors(numpy.mean(self.images, axis=0))[0] - error / n) / (1 - 1 / n) / error

    def sources(self):
        """Shares of the expected squared relative error: the normalisation's, direct light's and the chains'."""
        error = geometric([run["relMSE"][1] for run in self.runs])
        found = {"normalisation": numpy.var(self.of_runs("meanRatio"), ddof=1) / error if len(self.runs) > 1 else None}
        noise = [run["statistics"].get("noise") for run in self.runs]
        if all(noise):
            for part in noise[0]:
                found[part] = numpy.mean([n[part] for n in noise]) / error
        return found


def rows_of(columns):
    yield "| | CPU s | a pixel | CPU s x relMSE | without 0.1 % | 1 % | 10 % | ratio | without 0.1 % | 1 % | 10 % |"
    yield "|---|---|---|---|---|---|---|---|---|---|---|"
    for column in columns:
        cells = [column.label, f"{numpy.mean(column.of_runs('cpuSeconds')):.2f}",
                 f"{numpy.mean(column.of_runs('perPixel')):.1f}"]
        cells += [f"{geometric(column.products(t)):.3g}" for t in range(len(TRIMS))]
        for t in range(len(TRIMS)):
            logs = numpy.log(column.products(t)) - numpy.log(columns[0].products(t))
            mean, half = interval(list(logs))
            cells.append("1" if column is columns[0]
                         else f"{math.exp(mean):.3f} ({math.exp(mean - half):.2f} - {math.exp(mean + half):.2f})")
        yield "| " + " | ".join(cells) + " |"


def details_of(scene, columns):
    for column in columns:
        runs = column.runs
        worth = [1 / (run["relMSE"][1] * run["perPixel"]) for run in runs]
        cost = [1e6 * run["cpuSeconds"] / (run["perPixel"] * scene.size[0] * scene.size[1]) for run in runs]
        mean, half = interval(column.of_runs("meanRatio"))
        yield (f"{column.label}: {geometric(cost):.2f} us and {geometric(worth):.3g} independent samples a mutation; "
               f"mean {mean:.4f} +- {half:.4f}")
        near = column.correlation(scene)
        yield "  correlation " + ", ".join(f"{d} px {c:+.3f}" for d, c in near.items())
        shares = {"bias": column.bias(scene), **column.sources()}
        yield "  of the error " + ", ".join(f"{name} {share:.2f}" for name, share in shares.items()
                                            if share is not None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", action="append", help="a name or a file; repeatable")
    parser.add_argument("--method", action="append", help="as h2mc render's -i; repeatable")
    parser.add_argument("--program", action="append", help="repeatable")
    parser.add_argument("--width", type=int, help="that all references must have")
    parser.add_argument("--mutations", type=int, default=64, help="a pixel")
    parser.add_argument("--seconds", type=float, help="instead of mutations")
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1, help="of each render")
    parser.add_argument("--at-once", type=int, default=1, help="renders side by side")
    parser.add_argument("--store", help="file for all figures")
    options = parser.parse_args()
    programs = options.program or [str(ROOT / "build/release/h2mc")]
    methods = options.method or ["h2mc"]
    scenes = [Scene(name, options.width) for name in options.scene or ["torus", "ring", "bathroom", "cars"]]
    cells = [(program, method) for program in programs for method in methods]
    found = {}
    with tempfile.TemporaryDirectory(prefix="h2mc_laboratory_") as folder:
        for scene in scenes:
            columns = [Column(m if len(programs) == 1 else f"{p} {m}") for p, m in cells]
            seeds = range(options.first_seed, options.first_seed + options.seeds)
            with concurrent.futures.ThreadPoolExecutor(options.at_once) as pool:
                jobs = [(column, seed, pool.submit(render, p, scene, m, options, seed, pathlib.Path(folder)))
                        for seed in seeds for column, (p, m) in zip(columns, cells)]
                for column, seed, job in jobs:
                    column.add(scene, seed, *job.result())
            print(f"\n{scene.name}, {scene.size[0]} x {scene.size[1]}\n")
            for line in rows_of(columns):
                print(line)
            print()
            for line in details_of(scene, columns):
                print(line)
            sys.stdout.flush()
            found[scene.name] = {column.label: column.runs for column in columns}
    if options.store:
        pathlib.Path(options.store).write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
