#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The page of h2mc compare in a browser: headless Chromium and Firefox, driven by Selenium. Skipped without."""

import json

import _browser
import _h2mc

try:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.keys import Keys
except ImportError:
    pass  # _browser then says so


class Page(_browser.Page):
    def setUp(self):
        super().setUp()
        self.write("box.xml", _h2mc.SCENE)
        self.write("dim.xml", _h2mc.SCENE.replace('name="radiance" value="4"', 'name="radiance" value="0.01"'))
        self.succeeds("compare", "box.xml", "dim.xml", "-i", "path,bdpt,path:maxDepth=2", "-m", "2,4,16", "-k", 2,
                      "-r", "auto", "--reference-time", 0.3, "--width", 48, "-o", "out")
        self.open("out/index.html")

    def caption(self):
        return self.one(".view figcaption b").text

    def canvas_sum(self):
        return super().canvas_sum(".view canvas")

    def pixel_of(self, name, x, y):
        """From the EXR file itself."""
        rows = self.pixel_rows(name)
        self.assertEqual((len(rows[0]), len(rows)), (48, 32))
        return rows[y][x]

    def test_everything(self):
        self.assertEqual([e.text for e in self.all("#scenes button")], ["box", "dim"])
        self.assertEqual(len(self.all("#ranking tbody tr")), 3)
        with open(self.path("out/results.json"), encoding="utf-8") as stream:
            results = json.load(stream)
        box = results["scenes"][0]
        summary = next(s for s in box["summaries"] if s["metric"] == "relmse" and not s["timed"])
        shown = [float(c.get_attribute("data-value")) for c in self.all("#ranking td[data-value]")]
        for value, method in zip(shown, summary["order"]):
            self.assertAlmostEqual(value, summary["methods"][method]["error"]["value"], delta=1e-6 * value)
        self.assertTrue(self.all("#chart-time svg polyline") and self.all("#chart-work svg polygon"))
        self.assertEqual(len(self.all("#all-scenes svg")), 2)
        # The path of two edges lacks light, and that is no scatter.
        self.assertIn("brightness off", self.one("#ranking tr[data-method='2']").text)

        # Keys and clicks choose what is seen.
        self.assertEqual(self.caption(), "path")
        self.key("2")
        self.assertEqual(self.caption(), "bdpt")
        self.key("r")
        self.assertEqual(self.caption(), "reference")
        self.key("r")
        self.assertEqual(self.caption(), "bdpt")
        self.one("#chips button[data-picture='2']").click()
        self.assertEqual(self.caption(), "path:maxDepth=2")
        self.key("9")  # there is none
        self.assertEqual(self.caption(), "path:maxDepth=2")
        self.key("1")

        # Values under the cursor are those of the files.
        canvas = self.one(".view canvas")
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", canvas)
        for u, v in ((0.3, 0.4), (-0.35, 0.1), (0.05, -0.3)):
            size = canvas.size
            ActionChains(self.driver).move_to_element_with_offset(
                canvas, int(u * size["width"]), int(v * size["height"])).perform()
            head = self.one("#readout th[data-x]")
            x, y = int(head.get_attribute("data-x")), int(head.get_attribute("data-y"))
            self.assertAlmostEqual(x / 48, 0.5 + u, delta=0.03)
            self.assertAlmostEqual(y / 32, 0.5 + v, delta=0.05)
            for index, method in enumerate(box["methods"]):
                image = "out/" + method["repeats"][0]["points"][-1]["image"]
                cells = self.all(f"#readout tr[data-picture='{index}'] td[data-value]")
                for cell, expected in zip(cells, self.pixel_of(image, x, y)):
                    self.assertAlmostEqual(float(cell.get_attribute("data-value")), expected,
                                           delta=1e-3 * abs(expected) + 1e-6)
                self.assertEqual(len(cells), 3)

        # Exposure and error maps change the picture; zoom and drag move it.
        before = self.canvas_sum()
        self.driver.execute_script(
            "const e = document.getElementById('exposure'); e.value = Number(e.value) + 2;"
            "e.dispatchEvent(new Event('input'))")
        brighter = self.canvas_sum()
        self.assertGreater(brighter, before)
        self.key("e")
        self.assertNotEqual(self.canvas_sum(), brighter)
        self.one("#show button[data-show='color']").click()
        self.assertEqual(self.canvas_sum(), brighter)
        self.one("#zoom-in").click()
        self.assertIn("zoomed", canvas.get_attribute("class"))
        zoomed = self.canvas_sum()
        ActionChains(self.driver).move_to_element(canvas).click_and_hold().move_by_offset(60, 40).release().perform()
        self.assertNotEqual(self.canvas_sum(), zoomed)
        self.key("0")
        self.assertNotIn("zoomed", canvas.get_attribute("class"))

        # Side by side, slider, insets.
        self.one("#mode button[data-mode='side']").click()
        self.assertEqual([e.text for e in self.all(".view figcaption b")],
                         ["path", "bdpt", "path:maxDepth=2", "reference"])
        self.one("#mode button[data-mode='slider']").click()
        self.assertEqual(self.caption(), "path | reference")
        split = self.canvas_sum()
        canvas = self.one(".view canvas")
        ActionChains(self.driver).move_to_element(canvas).click_and_hold().move_by_offset(150, 0).release().perform()
        self.assertNotEqual(self.canvas_sum(), split)
        rows = len(self.all(".inset"))
        self.assertGreaterEqual(rows, 1)
        self.key("i")
        ActionChains(self.driver).move_to_element_with_offset(canvas, -200, -100).click_and_hold() \
            .move_by_offset(150, 90).release().perform()
        self.assertEqual(len(self.all(".inset")), rows + 1)
        self.all(".inset .remove")[0].click()
        self.assertEqual(len(self.all(".inset")), rows)

        # The other scene, another metric, the other axis.
        self.key(Keys.ARROW_RIGHT)
        self.assertEqual(self.all("#scenes button")[1].get_attribute("aria-selected"), "true")
        ranking = self.one("#ranking").text
        self.one("#metric option:nth-child(7)").click()
        self.assertIn("hdr-flip", self.one("#ranking").text)
        self.assertNotEqual(self.one("#ranking").text, ranking)
        self.one("#axis option[value='time']").click()
        self.assertIn(" s", self.one("#ranking th:nth-child(3)").text)
        self.key(Keys.ARROW_RIGHT)
        self.assertEqual(self.all("#scenes button")[0].get_attribute("aria-selected"), "true")
        self.no_errors()
        self.fits_a_phone()


class InFirefox(Page):
    start = _browser.firefox


if __name__ == "__main__":
    _browser.main("compare")
