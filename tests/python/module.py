# SPDX-License-Identifier: MIT
"""The Python module as a notebook would use it."""

import ast
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import h2mc

ROOT = os.environ["H2MC_SOURCE_DIR"]
BINARY = os.environ["H2MC_BINARY"]

sys.path.insert(0, os.path.join(ROOT, "scenes"))
import exr  # noqa: E402  (what the scenes' scripts share)


def scene_file(name):
    return os.path.join(ROOT, "scenes", name, name + ".xml")


LENS = """<scene version="0.6.0"><integrator type="path"/>
<sensor type="thinlens"><float name="apertureRadius" value="0.2"/><float name="focusDistance" value="4"/>
  <transform name="toWorld"><lookat origin="0, 1, 4" target="0, 0.5, 0" up="0, 1, 0"/></transform>
  <float name="fov" value="40"/><film type="hdrfilm"><integer name="width" value="16"/>
  <integer name="height" value="12"/></film></sensor>
<shape type="rectangle"><transform name="toWorld"><scale value="3"/><rotate x="1" angle="-90"/></transform></shape>
<shape type="sphere"><float name="radius" value="$radius"/><point name="center" y="0.5"/>
  <bsdf type="roughplastic"/></shape>
<shape type="sphere"><float name="radius" value="0.3"/><point name="center" y="2.5"/>
  <emitter type="area"><rgb name="radiance" value="9"/></emitter></shape>
</scene>"""


def lens_scene():
    return h2mc.load_string(LENS, defines={"radius": "0.5"})


class Scenes(unittest.TestCase):
    def test_load(self):
        scene = h2mc.load(scene_file("ring"), width=40)
        self.assertEqual(scene.width, 40)
        self.assertFalse(scene.moving or scene.aperture)
        self.assertIn("40 x", repr(scene))
        self.assertTrue(h2mc.load(scene_file("spinning")).moving)
        self.assertTrue(lens_scene().aperture)

    def test_mistakes(self):
        with self.assertRaisesRegex(h2mc.Error, "no such|cannot read"):
            h2mc.load("not there.xml")
        with self.assertRaisesRegex(h2mc.Error, "<string>:1:.*\n.*\n.*unknown|unknown"):
            h2mc.load_string('<scene version="0.6.0"><shape type="egg"/></scene>')
        with self.assertRaisesRegex(h2mc.Error, r"\$size"):
            h2mc.load_string(LENS, defines={"size": "1"})
        with self.assertRaisesRegex(h2mc.Error, "width"):
            h2mc.load(scene_file("ring"), width=-1)
        with self.assertRaises(TypeError):
            h2mc.load(scene_file("ring"), size=3)
        self.assertTrue(issubclass(h2mc.Error, ValueError))


class Rendering(unittest.TestCase):
    def test_same_as_the_command_line(self):
        """Bit for bit, statistics too."""
        for integrator in "path", "h2mc:maxDepth=5":
            budget = "samples" if integrator == "path" else "mutations"
            image, statistics = h2mc.load(scene_file("ring"), width=32).render(
                integrator, **{budget + "_per_pixel": 4}, seed=7, threads=2)
            with tempfile.TemporaryDirectory() as folder:
                file = os.path.join(folder, "image.exr")
                subprocess.run([BINARY, "render", scene_file("ring"), "--width", "32", "-i", integrator, "-q",
                                f"--{budget}-per-pixel", "4", "--seed", "7", "-o", file], check=True)
                expected = h2mc.read_image(file)
            self.assertEqual((image.shape, image.dtype), (expected.shape, np.float32))
            self.assertTrue(np.array_equal(image, expected), integrator)
            self.assertEqual((statistics["seed"], statistics["sampleUnit"]), (7, budget))
            self.assertGreater(statistics["samples"], 0)

    def test_layers_are_those_of_the_command_line(self):
        """Bit for bit; and the picture is the same with them and without."""
        names = ["albedo", "normal", "depth", "position", "time", "id", "variance", "mutations"]
        for name, integrator in ("ring", "h2mc:maxDepth=5"), ("spinning", "path"):
            scene = h2mc.load(scene_file(name), width=32, height=24)
            budget = {"seed": 7, "samples_per_pixel" if integrator == "path" else "mutations_per_pixel": 4}
            image, _, layers = scene.render(integrator, aov=names, aov_samples=5, threads=2, **budget)
            self.assertTrue(np.array_equal(image, scene.render(integrator, **budget)[0]))
            with tempfile.TemporaryDirectory() as folder:
                file = os.path.join(folder, "image.exr")
                subprocess.run([BINARY, "render", scene_file(name), "--width", "32", "--height", "24", "-i", integrator,
                                "-q", "-s" if integrator == "path" else "-m", "4", "--seed", "7", "-o", file,
                                "--aov", ",".join(names), "--aov-samples", "5"], check=True)
                planes = exr.read_planes(file)[3]
            self.assertEqual(list(layers), names)
            for channel, values in planes.items():
                layer, _, letter = channel.partition(".")
                if not letter:
                    continue
                array = layers[layer]
                self.assertEqual(array.dtype, np.float32)
                if array.ndim == 3:
                    array = array[:, :, "RGBXYZ".index(letter) % 3]
                self.assertEqual(array.shape, (24, 32))
                self.assertTrue(np.array_equal(array.ravel(), np.array(values, dtype=np.float32)), channel)
                planes[channel] = None
            self.assertEqual(sum(values is None for values in planes.values()), 16)
        self.assertEqual(scene.render("path", samples_per_pixel=1, aov=[])[2], {})
        with self.assertRaisesRegex(h2mc.Error, "aov: unknown layer \"albdo\".*albedo"):
            scene.render("path", samples_per_pixel=1, aov=["albdo"])
        for bad in 0, 100_000:
            with self.assertRaisesRegex(h2mc.Error, "aov_samples"):
                scene.render("path", samples_per_pixel=1, aov=["albedo"], aov_samples=bad)

    def test_options(self):
        scene = h2mc.load(scene_file("ring"), width=16)
        _, statistics = scene.render("mmlt", {"maxDepth": 3, "sigma": 0.02}, mutations_per_pixel=2)
        self.assertEqual(str(statistics["integratorOptions"]["maxDepth"]), "3")
        for arguments, message in (({"integrator": "path", "options": {"sigma": 1}}, "sigma"),
                                   ({"integrator": "pth"}, "path"), ({"time": 1, "samples_per_pixel": 1}, "give one"),
                                   ({"time": -1}, "above 0"), ({"threads": -1}, "threads")):
            with self.assertRaisesRegex(h2mc.Error, message):
                scene.render(**arguments)

    def test_progress(self):
        seen = []
        ring = h2mc.load(scene_file("ring"), width=64)
        ring.render("path", time=1, progress=lambda *news: seen.append(news))
        self.assertGreater(len(seen), 1)
        self.assertTrue(all(0 <= fraction <= 1 and seconds >= 0 for fraction, seconds, _ in seen), seen)

        def fail(*_):
            raise KeyError("enough")
        begin = time.monotonic()
        with self.assertRaisesRegex(KeyError, "enough"):
            ring.render("path", time=60, progress=fail)
        self.assertLess(time.monotonic() - begin, 20)

    def test_interruption(self):
        ring = h2mc.load(scene_file("ring"), width=64)
        begin = time.monotonic()
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            ring.render("h2mc", time=60)
        self.assertLess(time.monotonic() - begin, 20)

    def test_lock_is_free(self):
        """Another thread of Python goes on."""
        counted = []
        stop = threading.Event()

        def count():
            while not stop.is_set():
                counted.append(time.monotonic())
                time.sleep(0.01)
        thread = threading.Thread(target=count)
        thread.start()
        h2mc.load(scene_file("ring"), width=64).render("path", time=0.7)
        stop.set()
        thread.join()
        self.assertGreater(len(counted), 10)


class Images(unittest.TestCase):
    def test_round_trip_and_metrics(self):
        image = np.random.default_rng(1).random((5, 7, 3), dtype=np.float32)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "a.exr")
            h2mc.write_image(file, image)
            self.assertTrue(np.array_equal(h2mc.read_image(file), image))
            with self.assertRaisesRegex(h2mc.Error, "a.xyz"):
                h2mc.write_image(os.path.join(folder, "a.xyz"), image)
        self.assertEqual(h2mc.metrics(image, image)["relmse"], 0)
        expected = np.mean((image * 1.1 - image) ** 2)
        self.assertAlmostEqual(h2mc.metrics(image * 1.1, image)["mse"] / expected, 1, 4)
        with self.assertRaisesRegex(h2mc.Error, "size"):
            h2mc.metrics(image, image[1:])
        with self.assertRaisesRegex(h2mc.Error, "shape"):
            h2mc.metrics(image[0], image[0])


class Targets(unittest.TestCase):
    def scenes(self):
        yield "ring", h2mc.load(scene_file("ring"))
        yield "spinning", h2mc.load(scene_file("spinning"))
        yield "lens", lens_scene()

    def test_names(self):
        technique = lens_scene().technique(1, 3)
        self.assertEqual(technique.dimension, 8)
        self.assertEqual(technique.names, ["u0", "u1", "u2", "u3", "u4", "u5", "aperture0", "aperture1", "choice0",
                                           "choice1"])
        self.assertEqual(h2mc.load(scene_file("spinning")).technique(0, 2).names, ["u0", "u1", "time"])

    def test_evaluation_is_the_image(self):
        """The mean contribution over a uniform primary space, of all techniques, is direct and one-bounce light."""
        scene = lens_scene()
        rng = np.random.default_rng(3)
        total, variance = 0, 0
        for s, t in (0, 2), (0, 3), (1, 2), (2, 1):
            technique = scene.technique(s, t)
            target = technique.evaluate(rng.random((200_000, len(technique.names))))["target"].astype(float)
            total += target.mean()
            variance += target.var() / len(target)
        image, _ = scene.render("path:maxDepth=2", samples_per_pixel=4096)
        luminance = (image @ np.array([0.212671, 0.715160, 0.072169])).mean()
        self.assertLess(abs(total / luminance - 1), 0.01 + 4 * variance ** 0.5 / luminance)

    def test_derivatives(self):
        """Float and double agree; double agrees with differences of the log target on the frozen topology."""
        for name, scene in self.scenes():
            for s, t in (0, 3), (1, 3), (2, 2), (3, 1):
                technique = scene.technique(s, t)
                x = technique.sample(60, seed=5)
                if len(x) < 20:
                    continue
                value, gradient, hessian = technique.differentiate(x)
                exact = technique.differentiate(x, "float64")
                self.assertEqual(hessian.shape, (len(x), technique.dimension, technique.dimension))
                self.assertEqual((value.dtype, exact[0].dtype), (np.float32, np.float64))
                self.assertTrue(np.array_equal(hessian, hessian.transpose(0, 2, 1), equal_nan=True))
                finite = np.isfinite(exact[2]).all((1, 2)) & np.isfinite(hessian).all((1, 2))
                self.assertGreater(finite.mean(), 0.9)
                scale = 1 + np.abs(exact[1]).max(1)
                off = np.abs(gradient - exact[1]).max(1) > 1e-2 * scale
                self.assertLess(off[finite].mean(), 0.1, name)
                np.testing.assert_allclose(np.log(technique.evaluate(x)["target"]), exact[0], atol=0.05)
                self.check_paths(technique, x[:8], exact)

    def check_paths(self, technique, x, exact):
        for i, row in enumerate(x):
            path = technique.trace(row)
            self.assertTrue(np.array_equal(path.x, row[:technique.dimension]))
            np.testing.assert_allclose(path.gradient(path.x), exact[1][i], rtol=1e-6, atol=1e-6)
            np.testing.assert_allclose(path.hessian(path.x), exact[2][i], rtol=1e-6, atol=1e-6)
            direction = np.random.default_rng(i).normal(size=technique.dimension)
            inside = np.minimum(path.x, 1 - path.x).min()
            step = 1e-4 * min(1, inside * 10) / (1 + np.abs(exact[1][i]).max())
            if step < 1e-9:
                continue
            slope = (path.log_target(path.x + step * direction) - path.log_target(path.x - step * direction)) / step / 2
            expected = path.gradient(path.x) @ direction
            self.assertLess(abs(slope - expected), 1e-3 * (1 + np.abs(exact[1][i]).max()))

    def test_convert(self):
        """The same path in another technique: same vertices, and the contribution by the ratio of weights."""
        scene = lens_scene()
        one, other = scene.technique(1, 3), scene.technique(2, 2)
        x = one.sample(40, seed=2)
        y = one.convert(x, other, seed=1)
        made = 0
        for a, b in zip(x, y):
            if np.isnan(b).any():
                continue
            there = other.trace(b)
            if there is None:
                continue
            np.testing.assert_allclose(one.trace(a).vertices[1:], there.vertices[1:], atol=1e-3)
            made += 1
        self.assertGreater(made, 20)
        with self.assertRaisesRegex(h2mc.Error, "as many edges"):
            one.convert(x, scene.technique(1, 2))

    def test_threads_change_nothing(self):
        technique = h2mc.load(scene_file("ring")).technique(1, 3)
        x = technique.sample(300)
        one, many = technique.differentiate(x, threads=1), technique.differentiate(x, threads=4)
        self.assertTrue(all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, many)))

    def test_mistakes(self):
        technique = h2mc.load(scene_file("ring")).technique(1, 2)
        x = np.full((2, len(technique.names)), 0.5)
        for bad, message in ((x[0], "shape"), (x[:, 1:], "shape"), (x + 0.5, r"row 0: u0 is 1"),
                             (x * np.nan, "row 0: u0 is nan"), (x - 1, "in \\[0, 1\\)")):
            with self.assertRaisesRegex(h2mc.Error, message):
                technique.evaluate(bad)
        with self.assertRaisesRegex(h2mc.Error, "float32 or float64"):
            technique.differentiate(x, "int32")
        with self.assertRaises((TypeError, ValueError)):
            technique.evaluate("x")
        for s, t in (1, 1), (-1, 3), (0, 1), (40, 2):
            with self.assertRaisesRegex(h2mc.Error, "no technique"):
                h2mc.load(scene_file("ring")).technique(s, t)


class Chains(unittest.TestCase):
    def means(self, scene, mutations, seeds=8, steps=20_000, **options):
        """Mean luminance of the left half of the film over all of it, and its standard error: what a chain decides."""
        shares = []
        for seed in range(seeds):
            chain = scene.chain(mutations, max_edges=3, seed=seed, **options)
            chain.step(steps)
            luminance = chain.image() @ np.array([0.212671, 0.715160, 0.072169])
            shares.append(luminance[:, :scene.width // 2].sum() / luminance.sum())
        return np.mean(shares), np.std(shares) / (seeds - 1) ** 0.5

    def reference(self, scene):
        image, _ = scene.render("path:maxDepth=3", samples_per_pixel=4096)
        luminance = image @ np.array([0.212671, 0.715160, 0.072169])
        return luminance[:, :scene.width // 2].sum() / luminance.sum()

    def test_own_mutation_keeps_the_target(self):
        scene = lens_scene()
        rng = np.random.default_rng(1)

        def narrow(technique, x):
            """Not symmetric: the step's size grows with the film position."""
            def deviation(at):
                return 0.02 + 0.3 * at[0]

            def log_density(a, b):
                d = technique.dimension
                return -0.5 * np.sum(((b - a)[:d] / deviation(a)) ** 2) - d * np.log(deviation(a))
            y = x.copy()
            y[:technique.dimension] += deviation(x) * rng.normal(size=technique.dimension)
            if not (0 <= y[0] < 1):
                return None
            return y, log_density(y, x) - log_density(x, y)
        expected = self.reference(scene)
        share, error = self.means(scene, {narrow: 1}, steps=6000, large_step=0.3)
        self.assertLess(abs(share - expected), 4 * error + 0.004)
        self.assertLess(error, 0.02)
        # A log ratio that is left out is seen.
        wrong, error = self.means(scene, {lambda technique, x: (lambda p: p and (p[0], 0))(narrow(technique, x)): 1},
                                  steps=6000, large_step=0.05)
        self.assertGreater(abs(wrong - expected), 4 * error)

    def test_mutations_of_the_program(self):
        scene = lens_scene()
        expected = self.reference(scene)
        for mutations in {"isotropic:sigma=0.05": 1}, {"hamiltonian": 1, "lens": 1}:
            share, error = self.means(scene, mutations)
            self.assertLess(abs(share - expected), 4 * error + 0.004, mutations)

    def test_state_and_statistics(self):
        scene = lens_scene()
        chain, again = (scene.chain({"isotropic": 3, "hamiltonian": 1}, seed=4) for _ in range(2))
        chain.step(3000)
        again.step(3000)
        self.assertTrue(np.array_equal(chain.image(), again.image()))
        statistics = chain.statistics
        self.assertEqual(list(statistics), ["large", "isotropic", "hamiltonian"])
        self.assertEqual(sum(of["proposed"] for of in statistics.values()), 3000)
        self.assertGreater(statistics["isotropic"]["proposed"], statistics["hamiltonian"]["proposed"])
        self.assertGreater(chain.path.target, 0)
        proposals = chain.propose(2, 20)
        self.assertEqual(len(proposals), 20)
        self.assertTrue(all(path is None or (path.s, path.t) == (chain.path.s, chain.path.t) for path, _ in proposals))
        self.assertTrue(any(acceptance > 0 for _, acceptance in proposals))

    def test_mistakes(self):
        scene = lens_scene()
        for mutations, message in (({"isotropc": 1}, "isotropic"), ({"isotropic:sigma=x": 1}, "sigma"),
                                   ({"isotropic": 0}, "above 0"), ({3: 1}, "callables")):
            with self.assertRaisesRegex(h2mc.Error, message):
                scene.chain(mutations)
        with self.assertRaisesRegex(h2mc.Error, "min_edges"):
            scene.chain({"isotropic": 1}, min_edges=5, max_edges=4)
        for step, error, message in ((lambda t, x: x, h2mc.Error, "log ratio"),
                                     (lambda t, x: (x[1:], 0), h2mc.Error, "coordinates"),
                                     (lambda t, x: (x * np.nan, 0), h2mc.Error, "u0"),
                                     (lambda t, x: (x, np.nan), h2mc.Error, "not a number"),
                                     (lambda t, x: 1 / 0, ZeroDivisionError, "")):
            chain = scene.chain({step: 1}, large_step=0)
            with self.assertRaisesRegex(error, message):
                chain.step(10)
        with self.assertRaisesRegex(h2mc.Error, "no steps"):
            scene.chain({"isotropic": 1}).image()


class Docs(unittest.TestCase):
    def test_examples(self):
        """Those of the page run, one after the other."""
        with open(os.path.join(ROOT, "docs", "python.md"), encoding="utf-8") as file:
            blocks = re.findall(r"(?ms)^```python\n(.*?)^```", file.read())
        self.assertGreater(len(blocks), 6)
        names = {}
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(os.path.join(ROOT, "scenes"), os.path.join(folder, "scenes"))
            before = os.getcwd()
            os.chdir(folder)
            try:
                for block in blocks:
                    exec(compile(block, "docs/python.md", "exec"), names)  # pylint: disable=exec-used
            finally:
                os.chdir(before)
        ratios = [names["path"].log_target(names["path"].x + d / np.sqrt(max(-names["curvature"][0], 1)) *
                                           names["narrow"]) for d in (0, 1)]
        self.assertTrue(np.isfinite(ratios).all())


class Stubs(unittest.TestCase):
    def test_stubs_are_complete(self):
        """Every name of the module, with its docstring, is in the stubs and the other way round."""
        with open(os.path.join(ROOT, "src", "python", "h2mc.pyi"), encoding="utf-8") as file:
            tree = ast.parse(file.read())
        stubs = {}
        for node in tree.body:
            if isinstance(node, ast.ClassDef):
                stubs[node.name] = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
            elif isinstance(node, ast.FunctionDef):
                stubs[node.name] = set()
        public = {name: getattr(h2mc, name) for name in dir(h2mc) if not name.startswith("_")}
        self.assertEqual(set(public), set(stubs))
        for name, thing in public.items():
            self.assertTrue(thing.__doc__, name)
            if isinstance(thing, type) and name != "Error":
                members = {m for m in vars(thing) if not m.startswith("_")}
                self.assertEqual(members, stubs[name], name)
                for member in members:
                    self.assertTrue(getattr(thing, member).__doc__.strip(), f"{name}.{member}")


if __name__ == "__main__":
    sys.exit(unittest.main())
