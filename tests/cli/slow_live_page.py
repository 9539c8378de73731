#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The page of h2mc render --serve in a browser: headless Chromium and Firefox, driven by Selenium. Skipped without."""

import subprocess
import time

import _browser
import _h2mc

try:
    from selenium.webdriver.common.action_chains import ActionChains
except ImportError:
    pass  # _browser then says so


class Page(_browser.Page):
    def setUp(self):
        super().setUp()
        self.write("scene.xml", _h2mc.SCENE)
        self.process = subprocess.Popen(
            [_h2mc.BINARY, "render", "scene.xml", "-i", _h2mc.quick("h2mc"), "-m", "100000000", "--width", "96",
             "--height", "64", "-o", "a.exr", "--serve", "0"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.process.stderr.close)
        self.addCleanup(self.process.wait)
        self.addCleanup(self.process.kill)
        for line in self.process.stderr:
            if "to be watched at" in line:
                self.visit(line.split()[-1])
                return
            if "made without cpp-httplib" in line:
                self.skipTest("this build serves no pages: it was made without libcpp-httplib-dev")
        self.fail("the program did not say where")

    def until(self, condition, seconds=60):
        late = time.monotonic() + seconds
        while not condition() and time.monotonic() < late:
            time.sleep(0.1)
        self.assertTrue(condition(), self.one("main").text)

    def loaded(self):
        self.until(lambda: self.one("#acceptance").text and self.one("#readout").text)

    def shown(self):
        return self.canvas_sum(".view canvas")

    def test_everything(self):
        self.assertEqual(self.one("#name").text, "scene.xml")
        self.loaded()
        self.assertEqual(self.one("#h-progress").text, "Rendering")
        self.assertIn("mutations/s", self.one("#numbers").text)
        self.assertIn(" %", self.one("#acceptance tbody").text)
        self.assertIn("left", self.one("#left").text)

        # It goes on by itself.
        before = self.one("#numbers").text
        self.until(lambda: self.one("#numbers").text != before)

        # The pixel that is pointed at; exposure, and the error in false colour.
        canvas = self.one(".view canvas")
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", canvas)
        ActionChains(self.driver).move_to_element(canvas).perform()
        # In one go, as news replace the elements.
        x, y, values = self.driver.execute_script("""
            const head = document.querySelector("#readout [data-x]").dataset;
            const cells = [...document.querySelectorAll("#readout [data-value]")];
            return [+head.x, +head.y, cells.map((cell) => +cell.dataset.value)];""")
        self.assertAlmostEqual(x, 48, delta=2)
        self.assertAlmostEqual(y, 32, delta=2)
        self.assertEqual(len(values), 5)
        self.assertTrue(0 < values[3] < 4 and 0 < values[4] < values[3], values)
        grey = self.shown()
        self.driver.execute_script(
            "const e = document.getElementById('exposure'); e.value = Number(e.value) - 3;"
            "e.dispatchEvent(new Event('input'))")
        self.assertLess(self.shown(), 0.9 * grey)
        self.key("e")
        self.assertEqual(self.one(".view figcaption b").text, "estimated error")
        # Grey has its channels alike; false colours have not.
        colourful = self.driver.execute_script(
            "const c = document.querySelector('.view canvas');"
            "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
            "let n = 0; for (let i = 0; i < d.length; i += 4) n += Math.abs(d[i] - d[i + 1]) > 20; return n / d.length")
        self.assertGreater(colourful, 0.01)
        self.one("#show button[data-show='color']").click()
        self.one("#zoom-in").click()
        self.assertIn("zoomed", canvas.get_attribute("class"))
        self.key("0")
        self.no_errors()
        self.fits_a_phone()

        # Stopped, as by Ctrl-C.
        self.one("#stop").click()
        self.until(lambda: self.one("#h-progress").text == "Stopped; what there was is in a.exr")
        self.assertFalse(self.one("#stop").is_enabled())
        self.assertEqual(self.process.wait(timeout=60), 130)
        self.assertEqual(self.read_exr("a.exr")[0]["interrupted"], 1)
        # The picture stays where it is.
        time.sleep(2)
        self.assertEqual(self.one("#h-progress").text, "Stopped; what there was is in a.exr")
        self.assertGreater(self.shown(), 0)


class InFirefox(Page):
    start = _browser.firefox


if __name__ == "__main__":
    _browser.main("render --serve")
