#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""h2mc diff"""

import _h2mc


class Diff(_h2mc.Test):
    def setUp(self):
        super().setUp()
        self.write_png("black.png", 8, 6, lambda x, y: (0, 0, 0))
        self.write_png("white.png", 8, 6, lambda x, y: (255, 255, 255))
        self.write_png("spot.png", 8, 6,
                       lambda x, y: (0, 255, 255) if (x, y) == (2, 3) else (255, 255, 255))
        self.write_png("wide.png", 9, 6, lambda x, y: (255, 255, 255))

    def values(self, *arguments):
        lines = self.succeeds("diff", *arguments).stdout.splitlines()
        return {name: float(value) for name, value in map(str.split, lines)}

    def test_all_metrics(self):
        values = self.values("spot.png", "white.png")
        error = 1 / (8 * 6 * 3)  # one channel of one pixel
        self.assertAlmostEqual(values["mse"], error, 6)
        self.assertAlmostEqual(values["mae"], error, 6)
        self.assertAlmostEqual(values["rmse"], error ** 0.5, 6)
        self.assertAlmostEqual(values["relmse"], error / 1.01, 6)
        self.assertAlmostEqual(values["mape"], error / 1.01, 6)
        self.assertAlmostEqual(values["smape"], 2 * error, 6)
        self.assertIn("psnr", values)
        self.assertIn("relmse-trimmed", values)
        self.assertAlmostEqual(values["mean-reference"], 1, 5)
        self.assertAlmostEqual(values["mean-ratio"], 1 - 0.212671 / 48, 5)
        self.assertEqual(values, self.values("spot.png", "white.png", "--metric", "all"))

    def test_one_metric(self):
        values = self.values("black.png", "white.png", "--metric", "mse")
        self.assertEqual(set(values), {"mse", "mean", "mean-reference", "mean-ratio"})
        self.assertAlmostEqual(values["mse"], 1, 6)

    def test_same_image(self):
        values = self.values("white.png", "white.png")
        self.assertEqual(values["mse"], 0)
        self.assertEqual(values["mean-ratio"], 1)

    def test_tolerance(self):
        spot = ("diff", "spot.png", "white.png")
        self.succeeds(*spot, "--metric", "mse", "--tolerance", 0.01)
        self.fails(1, *spot, "--metric", "mse", "--tolerance", 0.001, says="mse")
        self.succeeds(*spot, "--tolerance", 0.01)
        self.fails(1, *spot, "--tolerance", 0.001, says="relmse")
        self.succeeds(*spot, "--metric", "psnr", "--tolerance", 20)
        self.fails(1, *spot, "--metric", "psnr", "--tolerance", 30, says="psnr")
        self.fails(2, *spot, "--metric", "all", "--tolerance", 1, says="--metric")

    def test_bad_input(self):
        self.fails(2, "diff", "wide.png", "white.png", says=("9 x 6", "8 x 6"))
        self.fails(2, "diff", "none.png", "white.png", says="none.png")
        self.fails(2, "diff", "white.png", ".", says="it is a folder")
        self.write("text.png", "no picture")
        self.fails(2, "diff", "white.png", "text.png", says="text.png")
        self.fails(2, "diff", "white.png", "white.png", "--metric", "mss", says=("mss", "relmse"))
        self.fails(2, "diff", "white.png", "white.png", "-o", "nowhere/a.png", says="nowhere")
        self.fails(2, "diff", "white.png", "white.png", "--picture", "pretty", says="signed")

    def test_picture(self):
        for kind in ("signed", "relative"):
            for name in ("difference.png", "difference.exr"):
                self.succeeds("diff", "spot.png", "white.png", "-o", name, "--picture", kind)
                self.assertIn(name, self.files())
                self.fails(2, "diff", name, "wide.png", says="8 x 6")  # it has the images' size
        # Black where they agree.
        self.succeeds("diff", "white.png", "white.png", "-o", "same.png")
        self.assertEqual(self.values("same.png", "black.png")["mse"], 0)


if __name__ == "__main__":
    _h2mc.main()
