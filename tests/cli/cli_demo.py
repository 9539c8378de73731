#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc demo"""

import re

import _h2mc


class ImageCopy(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write_png("spot.png", 40, 30, lambda x, y: (255, 200, 40) if abs(x - y) < 4 else (20, 20, 30))

    def test_page(self):
        result = self.succeeds("demo", "image-copy", "spot.png", "--width", 20, "-o", "page.html")
        rows = [line.split() for line in result.stdout.splitlines()[1:]]
        self.assertEqual(len(rows), 16)  # four methods at four numbers of mutations
        errors = {(row[0], int(row[1])): float(row[3]) for row in rows}
        for name in ("small", "large", "mixed", "Hessian-Hamiltonian"):
            self.assertLess(errors[name, 256], errors[name, 1])
        with open(self.path("page.html"), encoding="utf-8") as stream:
            page = stream.read()
        self.assertIsNone(re.search(r"(src|href)\s*=\s*[\"']", page), "the page needs nothing else")
        self.succeeds("demo", "image-copy", "spot.png", "--width", 20, "-o", "again.html", "--threads", 1)
        with open(self.path("again.html"), encoding="utf-8") as stream:
            self.assertEqual(stream.read(), page)

    def test_mistakes(self):
        self.write_png("black.png", 8, 8, lambda x, y: (0, 0, 0))
        self.fails(2, "demo", "image-copy", "none.png", says="none.png")
        self.fails(2, "demo", "image-copy", "black.png", says="black")
        self.fails(2, "demo", "image-copy", "spot.png", "-o", "nowhere/a.html", says="nowhere")
        self.fails(2, "demo", "image-copy", "spot.png", "--width", 3, says="--width")
        self.fails(2, "demo", "image-copy", says="PICTURE")
        self.fails(2, "demo", says="subcommand")


if __name__ == "__main__":
    _h2mc.main()
