#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/make-reference.py SCENE.xml -i INTEGRATOR [--runs K] [--seconds T | --samples N] [...]

Renders the scene K times with different seeds and writes beside it reference.exr, the mean, and
reference_stderr.exr, the standard error of that mean in each pixel and channel. How they were made
stands in their headers.
"""

import argparse
import math
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "scenes"))
import exr  # noqa: E402


# Seeds apart from those of comparisons: a method must not be measured against its own samples.
FIRST_SEED = 1001


def rounded(values, bits):
    """To this many binary digits: noise below the standard error only makes files large."""
    result = []
    for value in values:
        mantissa, exponent = math.frexp(value)
        result.append(math.ldexp(round(mantissa * 2 ** bits), exponent - bits))
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("-i", "--integrator", default="bdpt", help="as for h2mc render (default: bdpt)")
    parser.add_argument("--runs", type=int, default=8, help="independent renders (default: 8)")
    budget = parser.add_mutually_exclusive_group()
    budget.add_argument("--seconds", type=float, default=10, help="for each of them (default: 10)")
    budget.add_argument("--samples", type=int, help="a pixel, for each of them")
    parser.add_argument("--width", type=int, default=128)
    parser.add_argument("--height", type=int, default=96)
    parser.add_argument("--threads", type=int, help="default: one a core")
    parser.add_argument("--h2mc", default=os.environ.get("H2MC_BINARY", os.path.join(ROOT, "build", "release",
                                                                                     "h2mc")))
    options = parser.parse_args()
    if options.runs < 2:
        parser.error("--runs: a standard error needs two")

    command = [options.h2mc, "render", options.scene, "-i", options.integrator, "--quiet",
               "--width", str(options.width), "--height", str(options.height)]
    command += (["--samples-per-pixel", str(options.samples)] if options.samples
                else ["--time", str(options.seconds)])
    if options.threads:
        command += ["--threads", str(options.threads)]
    images, luminances = [], []
    with tempfile.TemporaryDirectory(prefix="h2mc_reference_") as folder:
        for seed in range(FIRST_SEED, FIRST_SEED + options.runs):
            image = os.path.join(folder, f"{seed}.exr")
            subprocess.run([*command, "--seed", str(seed), "-o", image], check=True)
            _, width, height, planes = exr.read(image)
            images.append(planes)
            r, g, b = (sum(plane) / len(plane) for plane in planes)
            luminances.append(0.212671 * r + 0.715160 * g + 0.072169 * b)

    runs = len(images)
    mean = [[sum(values) / runs for values in zip(*(image[c] for image in images))] for c in range(3)]
    error = [[math.sqrt(sum((v - m) ** 2 for v in values) / (runs * (runs - 1)))
              for m, *values in zip(mean[c], *(image[c] for image in images))] for c in range(3)]
    luminance = sum(luminances) / runs
    luminance_error = math.sqrt(sum((v - luminance) ** 2 for v in luminances) / (runs * (runs - 1)))
    each = f"{options.samples} samples a pixel" if options.samples else f"{options.seconds:g} s"
    seeds = f"seeds {FIRST_SEED} to {FIRST_SEED + runs - 1}"
    texts = [("integrator", options.integrator), ("runs", f"{runs} of {each}, {seeds}"),
             ("meanLuminance", f"{luminance:.6g} (standard error {luminance_error:.2g})")]
    folder = os.path.dirname(os.path.abspath(options.scene))
    exr.write(os.path.join(folder, "reference.exr"), width, height, [rounded(c, 11) for c in mean], texts)
    exr.write(os.path.join(folder, "reference_stderr.exr"), width, height, [rounded(c, 5) for c in error],
              texts)
    print(f"{os.path.basename(options.scene)}: {options.integrator}, {runs} runs of {each}: mean luminance "
          f"{luminance:.6g}, standard error {luminance_error:.2g} ({100 * luminance_error / luminance:.2g} %)")


if __name__ == "__main__":
    main()
