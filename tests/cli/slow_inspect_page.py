#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The page of h2mc inspect in a browser."""

import json
import math

import _browser
import _h2mc

try:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.keys import Keys
except ImportError:
    pass  # _browser then says so

LANDSCAPE = "#landscapes canvas"


class Page(_browser.Page):
    def setUp(self):
        super().setUp()
        self.write("box.xml", _h2mc.SCENE)
        self.succeeds("inspect", "box.xml", "--pixel", "10,12", "-i", "h2mc:maxDepth=5", "--resolution", 33,
                      "--json", "a.json", "-o", "out", "--threads", 1)
        with open(self.path("a.json"), encoding="utf-8") as stream:
            self.report = json.load(stream)
        self.open("out/index.html")

    def readout(self):
        return self.one("#readout").text

    def test_everything(self):
        report = self.report
        self.assertIn("10, 12 of box.xml", self.one("#title").text)
        self.assertEqual([e.text for e in self.all("#vertices li")], report["path"]["vertices"])
        self.assertEqual(len(self.all("#eigen tbody tr")), report["model"]["dimension"])
        self.assertEqual([e.text for e in self.all("#mutations td:first-child")], [k["name"] for k in report["kinds"]])
        self.assertEqual(len(self.all("#kinds canvas")), len(report["kinds"]))
        self.assertEqual(self.one("#pair").get_attribute("value"), "0")
        self.assertTrue(self.readout().startswith("e1 0, e2 0: target 1 times"))

        # The value under the cursor is the program's.
        canvas = self.one(LANDSCAPE)
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", canvas)
        slice_ = report["pairs"][0]["wide"]
        size = canvas.size["width"] - 70  # the axes' margins are 62 left, 8 right, 4 above, 40 below
        for column, row in ((20, 10), (5, 28), (16, 16)):
            x = 62 + (column + 0.5) / 33 * size - canvas.size["width"] / 2
            y = 4 + (row + 0.5) / 33 * size - canvas.size["height"] / 2
            ActionChains(self.driver).move_to_element_with_offset(canvas, round(x), round(y)).perform()
            expected = slice_["logRatio"][33 * row + column]
            if expected is None:
                self.assertRegex(self.readout(), "no light|outside")
            else:
                shown = float(self.readout().split("target ")[1].split(" times")[0])
                self.assertAlmostEqual(shown, math.exp(expected), delta=0.006 * math.exp(expected))

        # Planes, sizes, colours.
        before = self.canvas_sum(LANDSCAPE)
        self.key("c")
        self.assertIn("Close up", self.one("#view-text").text)
        self.assertNotEqual(self.canvas_sum(LANDSCAPE), before)
        self.one("#view button[data-view='wide']").click()
        self.assertEqual(self.one("#view button[data-view='wide']").get_attribute("aria-pressed"), "true")
        self.key("]")
        self.assertIn("e3", self.readout())
        self.assertEqual([e.text for e in self.all("#eigen tr.shown td:first-child")], ["e1", "e3"])
        self.key("[")
        self.one("#pair option:last-child").click()
        self.assertIn("u", self.readout())
        self.one("#pair option:first-child").click()
        self.one("#decades").send_keys(Keys.ARROW_RIGHT)
        self.assertIn("5 decades", self.one("#decades-text").text)
        # Without a mouse.
        self.driver.execute_script("arguments[0].focus()", canvas)
        canvas.send_keys(Keys.ARROW_RIGHT)
        self.assertNotIn("e1 0,", self.readout())
        self.no_errors()
        self.fits_a_phone()


class InFirefox(Page):
    start = _browser.firefox


if __name__ == "__main__":
    _browser.main("inspect")
