#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What scripts/soak.sh runs."""

import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scenes"))
import exr  # noqa: E402

WIDTH = 128  # of the pictures
WARM_UP = 0.2  # share of a run in which memory may grow
GROWTH, SLACK = 0.03, 2048  # that memory may grow by after it: a share, and kilobytes
PHASES_SLACK = 16384  # for variations: bdpt's picture, then h2mc's, whose buffers are others
SHORTEST = 10  # seconds: memory of shorter runs is still growing into its buffers


def resident(pid):
    """Kilobytes, or None once the process is gone."""
    try:
        for line in pathlib.Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines():
            if line.startswith("VmRSS:"):
                return int(line.split()[1])
    except OSError:
        pass
    return None


def run(command):
    """(exit code, stderr, seconds, resident kilobytes over its time)."""
    begin, memory = time.monotonic(), []
    with tempfile.TemporaryFile("w+") as errors:
        with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors) as process:
            while process.poll() is None:
                now = resident(process.pid)
                if now:
                    memory.append(now)
                # Often enough for short runs, not so often that long ones gather millions.
                time.sleep(0.02 if time.monotonic() - begin < 60 else 0.5)
        errors.seek(0)
        return process.returncode, errors.read(), time.monotonic() - begin, memory


def growth(memory, seconds, slack):
    """(kilobytes by which the second half's peak is above the first's, whether that is too much), after the warm-up;
    (None, False) where the run was too short to tell."""
    if seconds < SHORTEST:
        return None, False
    memory = memory[int(WARM_UP * len(memory)):]
    half = len(memory) // 2
    first = max(memory[:half])
    more = max(memory[half:]) - first
    return more, more > GROWTH * first + slack


class Soak:
    def __init__(self, options, folder):
        self.options, self.folder, self.rows = options, pathlib.Path(folder), []

    def h2mc(self, *arguments):
        result = subprocess.run([self.options.program, *map(str, arguments)], capture_output=True, text=True,
                                check=False)
        if result.returncode not in (0, 1):
            sys.exit(f"{' '.join(map(str, arguments))}: {result.stderr}")
        return result.stdout

    def variations(self, scene):
        """Those that change something in the scene, and have pictures."""
        report = self.folder / "variations.json"
        self.h2mc("stress", scene, "--samples", 0, "--paths", 2, "-q", "--json", report)
        names = [v["name"] for v in json.loads(report.read_text(encoding="utf-8"))["variations"]]
        return [name for name in names if name != "as-is" and not name.startswith("u=")]

    def pixels(self, scene):
        report = self.folder / "size.json"
        self.h2mc("render", scene, "--width", WIDTH, "-s", 1, "-i", "path", "-q", "-o", self.folder / "size.exr",
                  "--stats", report)
        size = json.loads(report.read_text(encoding="utf-8"))
        return size["width"] * size["height"]

    def add(self, name, code, errors, seconds, memory, slack=SLACK, **found):
        more, grows = growth(memory, seconds, slack)
        row = {"name": name, "seconds": seconds, "peak": max(memory, default=0), "growth": more, **found}
        wrong = [f"{what} {row[what]}" for what in ("notFinite", "badPixels") if row.get(what)]
        if grows:
            wrong.append(f"memory grows by {more} kB")
        if code:
            wrong.append(f"exit code {code}: {errors.strip().splitlines()[-1] if errors.strip() else ''}")
        row["wrong"] = "; ".join(wrong)
        self.rows.append(row)
        print(self.line(row), file=sys.stderr, flush=True)

    def render(self, scene, mutations):
        image, report = self.folder / "image.exr", self.folder / "stats.json"
        each = max(1, math.ceil(mutations / self.pixels(scene)))
        for old in (image, report):
            old.unlink(missing_ok=True)
        code, errors, seconds, memory = run(
            [self.options.program, "render", scene, "-i", "h2mc", "--width", str(WIDTH), "-m", str(each), "-q",
             "-o", image, "--stats", report])
        found = {"mutations": 0, "notFinite": 0, "badPixels": 0}
        if code == 0:
            stats = json.loads(report.read_text(encoding="utf-8"))
            found["mutations"] = stats["samples"]
            found["notFinite"] = stats["statistics"].get("not finite", 0)
            planes = exr.read(image)[3]
            found["badPixels"] = sum(not (math.isfinite(v) and v >= 0) for plane in planes for v in plane)
        self.add(scene.stem, code, errors, seconds, memory, **found)

    def stress(self, scene, variation, mutations):
        report = self.folder / "stress.json"
        report.unlink(missing_ok=True)
        code, errors, seconds, memory = run(
            [self.options.program, "stress", scene, "--only", variation, "--samples", str(math.ceil(mutations)),
             "-q", "--json", report])
        found = {"mutations": 0, "notFinite": 0, "badPixels": 0}
        if report.exists():
            result = json.loads(report.read_text(encoding="utf-8"))["variations"][0]
            pictures = result.get("pictures") or {}
            if "error" not in result:
                found = {"mutations": math.ceil(mutations) if pictures else 0, "notFinite": result["notFinite"],
                         "badPixels": pictures.get("brokenPixels", 0)}
                # That pictures differ is for `h2mc stress` to judge; five standard errors are met by chance here.
                found["z"] = pictures.get("z")
                if code == 1 and not (found["notFinite"] or found["badPixels"]):
                    code = 0
        self.add(f"{scene.stem} {variation}", code, errors, seconds, memory, PHASES_SLACK, **found)

    def everything(self):
        scenes = sorted(ROOT.glob("scenes/*/*.xml"))
        if self.options.scene:
            scenes = [scene for scene in scenes if scene.stem in self.options.scene]
        if not scenes:
            sys.exit("no such scene")
        variations = [(scene, name) for scene in scenes for name in self.variations(scene)]
        for scene in scenes:
            self.render(scene, self.options.mutations / 2 / len(scenes))
        for scene, name in variations:
            self.stress(scene, name, self.options.mutations / 2 / len(variations))

    @staticmethod
    def line(row):
        more = "-" if row["growth"] is None else f"{row['growth'] / 1024:+.1f}"
        return (f"| {row['name']} | {row['mutations'] / 1e6:.4g} M | {row['seconds']:.0f} s | {row['notFinite']} "
                f"| {row['badPixels']} | {row['peak'] / 1024:.0f} MB | {more} MB | {row['wrong']} |")

    def table(self):
        """Markdown; the variations of a scene in one row."""
        rows = []
        for row in self.rows:
            scene, _, variation = row["name"].partition(" ")
            name = f"{scene}, variations" if variation else scene
            if not (rows and rows[-1]["name"] == name):
                rows.append({"name": name, "mutations": 0, "seconds": 0, "notFinite": 0, "badPixels": 0, "peak": 0,
                             "growth": None, "wrong": ""})
            total = rows[-1]
            for what in ("mutations", "seconds", "notFinite", "badPixels"):
                total[what] += row[what]
            total["peak"] = max(total["peak"], row["peak"])
            if row["growth"] is not None:
                total["growth"] = max(total["growth"] if total["growth"] is not None else row["growth"], row["growth"])
            if row["wrong"]:
                said = (variation + ": " if variation else "") + row["wrong"]
                total["wrong"] += ("; " if total["wrong"] else "") + said
        head = ("| scene | mutations | time | not finite | pixels not finite or below 0 | peak memory | growth | |\n"
                "|---|---|---|---|---|---|---|---|")
        return "\n".join([head, *map(self.line, rows)])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mutations", nargs="?", type=float, default=1e9)
    parser.add_argument("--scene", action="append", help="of this name alone; repeatable")
    parser.add_argument("--program", default=str(ROOT / "build/release/h2mc"))
    parser.add_argument("--json", help="file for everything that was found")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="h2mc_soak_") as folder:
        soak = Soak(options, folder)
        soak.everything()
    print(soak.table())
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(soak.rows, indent=1) + "\n", encoding="utf-8")
    total = sum(row["mutations"] for row in soak.rows)
    wrong = [row for row in soak.rows if row["wrong"]]
    judged = [row for row in soak.rows if row["growth"] is not None]
    print(f"\n{total / 1e6:.5g} million mutations in {len(soak.rows)} renders, {len(wrong)} with something wrong; "
          f"memory was judged in {len(judged)}, the others were too short")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
