#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/gallery.py [SCENE ...] [--per-pixel N] [--work DIR]

Renders the scenes at 1024 pixels of width, with so many mutations or samples a pixel, and makes docs/gallery of them: a
JPEG each, and a README with command, processor time and estimated error. What it has rendered stays in the work folder,
with checkpoints: the same call with a larger number goes on from there. Without one it renders nothing and makes the
pages of what there is. Needs ImageMagick's convert.
"""

import argparse
import os
import re
import struct
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "scenes"))
import exr  # noqa: E402  (what the scenes' scripts share)

OUT = os.path.join(ROOT, "docs", "gallery")
# With the integrator that has the least error in docs/measurements.md, or nearly so.
SCENES = {"ring": "h2mc", "torus": "h2mc", "bathroom": "h2mc", "cars": "h2mc", "spinning": "h2mc", "door": "h2mc",
          "pool": "h2mc", "swords": "h2mc", "cornell": "path", "veach-mis": "path", "furnace": "path"}
MOST_BYTES = 6_000_000  # all together
QUALITY = 88
WANTED = 1e-3
HEAD = """# Gallery

The project's scenes at 1024 pixels of width, by `scripts/gallery.py`. The error is relMSE as [`h2mc
diff`](../comparing.md#two-images) reckons it, with the [variance layer](../pictures.md#layers) for the squared error
and the picture for the reference. Below 0.001 noise is hard to see. The pictures are from a machine of two cores; `-m`
and `-s` are mutations and samples a pixel.
"""


def file_of(scene):
    return os.path.join("scenes", scene, scene + ".xml")


def command_of(scene):
    """Words of the command that made the picture, but for its time and what is for going on only."""
    return ["render", file_of(scene), "-i", SCENES[scene], "--scale", "2", "--aov", "variance", "--png"]


def budget_of(scene):
    return "-s" if SCENES[scene] == "path" else "-m"


def render(options, scene):
    image = os.path.join(options.work, scene + ".exr")
    command = [options.h2mc, *command_of(scene), "-o", image, budget_of(scene), str(options.per_pixel), "--threads",
               str(options.threads), "--checkpoint", os.path.join(options.work, scene + ".state"), "--quiet"]
    if os.path.exists(command[command.index("--checkpoint") + 1]):
        command.append("--resume")
    # Code 130: stopped, with what there is.
    code = subprocess.run(command, cwd=ROOT, preexec_fn=lambda: os.nice(19), check=False).returncode
    if code not in (0, 130):
        sys.exit(f"gallery.py: h2mc ended with code {code}")
    return code


def error_of(planes):
    """relMSE as h2mc diff has it: the estimated variance is the squared error, the picture the reference."""
    total, count = 0.0, 0
    mean = sum(share * sum(planes[letter]) / len(planes[letter])
               for letter, share in (("R", 0.212671), ("G", 0.715160), ("B", 0.072169)))
    for letter in "RGB":
        for value, variance in zip(planes[letter], planes["variance." + letter], strict=True):
            total += variance / (value * value + 0.01 * mean * mean)
            count += 1
    return total / count


def number(attribute):
    return struct.unpack("<d" if len(attribute) == 8 else "<f", attribute)[0]


def shown_time(seconds):
    return f"{seconds:.0f} s" if seconds < 600 else f"{seconds / 60:.0f} min"


def row_of(options, scene):
    image = os.path.join(options.work, scene + ".exr")
    attributes, width, height, planes = exr.read_planes(image)
    cpu, samples = (number(attributes[name]) for name in ("cpuSeconds", "samples"))
    error = error_of(planes)
    picture, png = os.path.join(OUT, scene + ".jpg"), os.path.join(options.work, scene + ".png")
    subprocess.run([options.h2mc, "convert", image, png], check=True)
    subprocess.run(["convert", png, "-strip", "-quality", str(QUALITY),
                    picture], check=True)
    with open(os.path.join(ROOT, "scenes", scene, "README.md"), encoding="utf-8") as stream:
        title = re.search(r"^# (.*)", stream.read()).group(1)
    command = " ".join(["h2mc", *command_of(scene), budget_of(scene), f"{samples / width / height:.0f}", "-o",
                        scene + ".exr"])
    reached = "" if error < WANTED else f"; {WANTED:g} would take some {shown_time(cpu * error / WANTED)}"
    return (f"## {title}\n\n![{title}]({scene}.jpg)\n\n    {command}\n\n"
            f"{width} x {height}, {shown_time(cpu)} of one core's time, estimated relMSE {error:.2g}{reached}. "
            f"[About the scene](../../scenes/{scene}/README.md).\n"), error


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="*", help="default: all")
    parser.add_argument("--per-pixel", type=int, help="mutations or samples, all that was before included")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--work", default="gallery-work", help="folder for images and checkpoints (%(default)s)")
    parser.add_argument("--h2mc", default=os.environ.get("H2MC_BINARY", os.path.join(ROOT, "build", "release",
                                                                                     "h2mc")))
    options = parser.parse_args()
    for scene in options.scene:
        if scene not in SCENES:
            parser.error(f"no scene {scene}: {', '.join(SCENES)}")
    options.work = os.path.abspath(options.work)
    os.makedirs(options.work, exist_ok=True)
    if options.per_pixel:
        for scene in options.scene or SCENES:
            if render(options, scene) == 130:
                sys.exit(130)
        return
    os.makedirs(OUT, exist_ok=True)
    text = HEAD
    for scene in SCENES:
        row, _ = row_of(options, scene)
        text += "\n" + row
    size = sum(os.path.getsize(os.path.join(OUT, scene + ".jpg")) for scene in SCENES)
    if size > MOST_BYTES:
        sys.exit(f"gallery.py: the pictures have {size} bytes together, more than {MOST_BYTES}")
    with open(os.path.join(OUT, "README.md"), "w", encoding="utf-8") as stream:
        stream.write(text)


if __name__ == "__main__":
    main()
