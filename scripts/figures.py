#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/figures/equal-time.svg from the table of methods at equal time in docs/measurements.md.

    scripts/figures.py [--check]

--check writes nothing: exit code 1 if the figure is not that of the table.
"""
import argparse
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FIGURE = ROOT / "docs/figures/equal-time.svg"
COLORS = {"path": "#9a9a9a", "bdpt": "#4477aa", "mmlt": "#ddaa33", "h2mc": "#bb3344"}
LEFT, TOP, ROW, WIDTH, BOTTOM = 84, 40, 24, 640, 44


def read_table(text):
    """Returns (methods, [(scene, [relMSE of each method])]) of the table with a column for each of COLORS."""
    lines = iter(text.splitlines())
    for line in lines:
        methods = re.findall(r"`(\w+)`", line)
        if line.startswith("| scene |") and set(methods) == set(COLORS) and "trimmed" not in line:
            break
    else:
        sys.exit("figures: docs/measurements.md has no table of these methods: " + ", ".join(COLORS))
    next(lines)
    rows = []
    for line in lines:
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) != len(methods) + 1:
            break
        rows.append((cells[0], [float(cell.split(",")[0].strip("* ")) for cell in cells[1:]]))
    return methods, rows


def draw(methods, rows):
    values = [value for _, errors in rows for value in errors]
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    height = TOP + ROW * len(rows) + BOTTOM

    def across(value):
        return LEFT + (WIDTH - LEFT - 20) * (math.log10(value) - low) / (high - low)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" '
           f'viewBox="0 0 {WIDTH} {height}" font-family="sans-serif" font-size="13">',
           f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>']
    bottom = TOP + ROW * len(rows)
    for power in range(low, high + 1):
        x = across(10 ** power)
        out.append(f'<line x1="{x:.1f}" y1="{TOP - 6}" x2="{x:.1f}" y2="{bottom}" stroke="#dddddd"/>')
        out.append(f'<text x="{x:.1f}" y="{bottom + 18}" text-anchor="middle" fill="#333333">'
                   f'10<tspan dy="-5" font-size="10">{str(power).replace("-", "&#8722;")}</tspan></text>')
    out.append(f'<text x="{(LEFT + WIDTH - 20) / 2:.1f}" y="{height - 8}" text-anchor="middle" fill="#333333">'
               "relMSE after 8 s, less is better</text>")
    for i, method in enumerate(methods):
        x = LEFT + 90 * i
        out.append(f'<circle cx="{x}" cy="18" r="6" fill="{COLORS[method]}"/>'
                   f'<text x="{x + 11}" y="23" fill="#333333">{method}</text>')
    for i, (scene, errors) in enumerate(rows):
        y = TOP + ROW * i + ROW / 2
        out.append(f'<text x="{LEFT - 10}" y="{y + 4:.1f}" text-anchor="end" fill="#333333">{scene}</text>')
        out.append(f'<line x1="{across(min(errors)):.1f}" y1="{y:.1f}" x2="{across(max(errors)):.1f}" y2="{y:.1f}" '
                   'stroke="#bbbbbb"/>')
        for method, error in zip(methods, errors):
            out.append(f'<circle cx="{across(error):.1f}" cy="{y:.1f}" r="6" fill="{COLORS[method]}" '
                       f'fill-opacity="0.85"><title>{scene}, {method}: {error:g}</title></circle>')
    out.append("</svg>")
    return "\n".join(out) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare, do not write")
    options = parser.parse_args()
    figure = draw(*read_table((ROOT / "docs/measurements.md").read_text(encoding="utf-8")))
    if not options.check:
        FIGURE.parent.mkdir(parents=True, exist_ok=True)
        FIGURE.write_text(figure, encoding="utf-8")
    elif not FIGURE.exists() or FIGURE.read_text(encoding="utf-8") != figure:
        sys.exit(f"figures: {FIGURE.relative_to(ROOT)} is not that of docs/measurements.md; run scripts/figures.py")


if __name__ == "__main__":
    main()
