# SPDX-License-Identifier: MIT
"""What the tests of pages share: headless Chromium and Firefox, driven by Selenium. Skipped without."""

import os
import shutil
import sys
import unittest

import _firefox
import _h2mc

SYSTEM_PYTHON = "/usr/bin/python3"  # where Debian's packages are seen
try:
    from selenium import webdriver
    from selenium.webdriver.common.by import By
    DRIVER = shutil.which("chromedriver")
except ImportError:
    DRIVER = None
    if os.path.exists(SYSTEM_PYTHON) and os.path.realpath(sys.executable) != os.path.realpath(SYSTEM_PYTHON):
        os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, *sys.argv])


def chromium(_, width=1440, height=900):
    options = webdriver.ChromeOptions()
    for flag in ("--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
                 "--disable-background-networking", "--disable-component-update", "--disable-sync",
                 "--disable-dev-shm-usage", f"--window-size={width},{height}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=webdriver.chrome.service.Service(DRIVER), options=options)


def firefox(test, width=1440, height=900):
    program = _firefox.Firefox(width, height)
    test.addCleanup(program.stop)
    return webdriver.Remote(program.url, options=webdriver.FirefoxOptions())


class Page(_h2mc.Test):
    """A subclass with start = _browser.firefox does the same in Firefox."""
    start = chromium

    def open(self, name):
        """A page in the test's folder."""
        self.visit("file://" + self.path(name))

    def visit(self, address):
        if self.start.__func__ is firefox and not _firefox.PROGRAM:
            raise unittest.SkipTest("not tried in Firefox: this needs the Debian package firefox-esr")
        self.driver = self.start()
        self.addCleanup(self.driver.quit)
        self.driver.get(address)

    def all(self, selector):
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def one(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def key(self, key):
        self.one("body").send_keys(key)

    def canvas_sum(self, selector):
        return self.driver.execute_script(
            f"const c = document.querySelector('{selector}');"
            "return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.reduce((a, b) => a + b, 0)")

    def loaded(self):
        """Returns when the page has all that it shows."""

    def no_errors(self):
        if self.start.__func__ is chromium:  # Firefox does not tell
            self.assertEqual([entry["message"] for entry in self.driver.get_log("browser")
                              if entry["level"] == "SEVERE"], [])

    def fits_a_phone(self):
        """Nothing sticks out; what was chosen is forgotten."""
        if self.start.__func__ is chromium:
            self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                        {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True})
        else:
            self.driver.set_window_size(500, 844)  # no window of Firefox is narrower than 450
        self.driver.refresh()
        self.loaded()
        wide, window = self.driver.execute_script(
            "return [document.documentElement.scrollWidth, document.documentElement.clientWidth]")
        self.assertLessEqual(window, 500)
        self.assertLessEqual(wide, window)
        hidden = self.driver.execute_script(
            "return [...document.querySelectorAll('.scroll')].filter((e) => e.scrollWidth > e.clientWidth + 1)"
            ".map((e) => e.textContent.slice(0, 80))")
        self.assertEqual(hidden, [], "tables that don't fit")


def main(page):
    if not DRIVER:
        print(f"SKIPPED: the page of h2mc {page} was not tried in a browser: this needs the Debian "
              "packages chromium, chromium-driver and python3-selenium", file=sys.stderr)
        sys.exit(77)
    _h2mc.main()
