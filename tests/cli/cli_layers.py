#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Layers of src: no include points to a layer above or beside; in the folders that have been cleared of them, no circle
of units (a header with its source) that need each other, and no circle of headers anywhere."""
import collections
import os
import pathlib
import re
import sys

SOURCE = pathlib.Path(os.environ.get("H2MC_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2])) / "src"

# What a layer may include besides itself; what its layers may include is included.
BELOW = {
    "ad": [],
    "render": ["ad"],
    "oiio": ["render"],
    "mpi": ["render"],
    "mcmc": ["render"],
    "check": ["mcmc"],
    "compare": ["mcmc"],
    "demo": ["compare"],
    "inspect": ["compare"],
    "cli": ["check", "demo", "inspect"],
    "serve": ["cli"],
    "figures": ["compare"],
    "python": ["mcmc"],
}

# Layers whose units need each other one way only. The others have units whose source needs a header that needs theirs.
ONE_WAY = ["ad", "compare", "demo", "cli", "python"]


def reachable(layer):
    return {layer}.union(*(reachable(below) for below in BELOW[layer]))


def includes(folder, suffixes):
    """Returns {unit: {units it includes}}, a unit being a path below src without its suffix."""
    graph = collections.defaultdict(set)
    for file in sorted(folder.rglob("*")):
        if file.suffix not in suffixes:
            continue
        unit = str(file.relative_to(folder).with_suffix(""))
        for name in re.findall(r'^#include "([^"]+)"', file.read_text(encoding="utf-8"), re.MULTILINE):
            if (folder / name).exists() and str(pathlib.Path(name).with_suffix("")) != unit:
                graph[unit].add(str(pathlib.Path(name).with_suffix("")))
    return graph


def circle(graph):
    """Returns one circle of units as a list, or None."""
    done, path, on_path = set(), [], set()

    def visit(unit):
        if unit in on_path:
            return path[path.index(unit):] + [unit]
        if unit in done:
            return None
        path.append(unit)
        on_path.add(unit)
        for next_unit in sorted(graph.get(unit, ())):
            found = visit(next_unit)
            if found:
                return found
        on_path.discard(path.pop())
        done.add(unit)
        return None

    for unit in sorted(graph):
        found = visit(unit)
        if found:
            return found
    return None


def main():
    graph = includes(SOURCE, (".h", ".cpp"))
    wrong = []
    for unit, needed in sorted(graph.items()):
        layer = unit.split("/")[0]
        if layer not in BELOW:
            wrong.append(f"src/{layer} is no layer that tests/cli/cli_layers.py knows")
            continue
        allowed = reachable(layer)
        wrong += [f"{unit} includes {other}, of a layer above or beside" for other in sorted(needed)
                  if other.split("/")[0] not in allowed]
    if len(graph) < 50:
        wrong.append(f"only {len(graph)} units with includes below {SOURCE}")
    checked = {unit: needed for unit, needed in graph.items() if unit.split("/")[0] in ONE_WAY}
    for found in (circle(checked), circle(includes(SOURCE, (".h",)))):
        if found:
            wrong.append("a circle: " + " -> ".join(found))
    # The test itself: both kinds of mistakes are seen.
    if circle({"a": {"b"}, "b": {"c"}, "c": {"a"}}) != ["a", "b", "c", "a"] or circle({"a": {"b"}, "b": set()}):
        wrong.append("circle() does not find circles")
    print("\n".join(dict.fromkeys(wrong)) or f"{len(graph)} units in order")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
