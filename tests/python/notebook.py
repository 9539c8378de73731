# SPDX-License-Identifier: MIT
"""The cells of docs/ridge.ipynb run, and say what the text around them says. Exit code 77 without matplotlib."""

import json
import os
import sys
import unittest

try:
    import matplotlib
except ImportError:
    print("SKIPPED: the notebook was not run: this needs the Debian package python3-matplotlib")
    sys.exit(77)
matplotlib.use("Agg")

ROOT = os.environ["H2MC_SOURCE_DIR"]


class Notebook(unittest.TestCase):
    def test_cells_run(self):
        with open(os.path.join(ROOT, "docs", "ridge.ipynb"), encoding="utf-8") as file:
            cells = [cell for cell in json.load(file)["cells"] if cell["cell_type"] == "code"]
        self.assertGreater(len(cells), 4)
        names = {}
        os.chdir(ROOT)
        for number, cell in enumerate(cells):
            text = "".join(cell["source"])
            exec(compile(text, f"docs/ridge.ipynb, cell {number}", "exec"), names)  # pylint: disable=exec-used
        # The path is on a ridge, Hamiltonian steps keep to it better than isotropic ones do.
        self.assertLess(names["curvature"][0], -1e5)
        isotropic, hamiltonian = (sum(a for _, a in names["chain"].propose(kind, 300)) for kind in (1, 2))
        self.assertGreater(hamiltonian, isotropic)


if __name__ == "__main__":
    sys.exit(unittest.main())
