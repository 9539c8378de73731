#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every parameter's range: what lies outside is refused with a message that says what is allowed, at its place; what
lies at its ends renders, and nothing in it is not finite."""

import re
import unittest

import _h2mc

GREY = re.search(r'<bsdf type="diffuse" id="grey">.*?</bsdf>', _h2mc.SCENE).group(0)
LAMP = re.search(r'<emitter type="area">.*?</emitter>', _h2mc.SCENE).group(0)
SENSOR = '<float name="fov" value="40"/>'
FILM = '<integer name="width" value="$width"/>'
FILTER = '<rfilter type="box"/>'
SPHERE = '<float name="radius" value="0.5"/>'
END = "</scene>"

NUMBER = ("nan", "inf", "-inf", "1e999", "x", "")


def bsdf(kind, parameter):
    return GREY, f'<bsdf type="{kind}" id="grey">{parameter}</bsdf>'


def number(name):
    return f'<float name="{name}" value="{{}}"/>'


def text(name):
    return f'<string name="{name}" value="{{}}"/>'


def color(name, more=""):
    return f'<rgb name="{name}" value="{{}}"/>{more}'


UNSCALED = '<boolean name="ensureEnergyConservation" value="false"/>'
EMITTER = '<emitter type="{}">{}</emitter></scene>'

BASE = GREY.replace(' id="grey"', "")

# What stands in the good scene, what stands there instead with {} for a value; values that are refused; words of the
# message; values that are accepted.
RANGES = {
    **{f"{kind} alpha": (*bsdf(kind, number("alpha")), ("-1", "-1e-9", "101", "1e30"),
                         ("from 0 to 100", "values up to 100", "must not be negative"),
                         ("0", "1e-30", "1e-4", "1", "100"))
       for kind in ("roughconductor", "roughdielectric", "roughplastic", "roughdiffuse")},
    **{f"{kind} {name}": (*bsdf(kind, number(name) + number(other).format("0.1")), ("-1", "101"), "from 0 to 100", ())
       for kind in ("roughconductor", "ward") for name, other in (("alphaU", "alphaV"), ("alphaV", "alphaU"))},
    "ward alphas": (*bsdf("ward", number("alphaU") + '<float name="alphaV" value="0.1"/>'), (), "",
                    ("0", "100")),
    "phong exponent": (*bsdf("phong", number("exponent")), ("-1", "1e9", "1e30"), "from 0 to 1e+08",
                       ("0", "1e8")),
    **{f"{kind} {name}": (*bsdf(kind, text(name)), ("0", "-1", "0.001", "101", "1e6"),
                          "a refractive index from 0.01 to 100", ("0.01", "100", "1.0001"))
       for kind in ("dielectric", "roughdielectric", "plastic", "roughplastic", "thindielectric")
       for name in ("intIOR", "extIOR")},
    "conductor extEta": (*bsdf("conductor", text("extEta")), ("0", "1e6"), "from 0.01 to 100",
                         ("0.01", "100")),
    **{f"{kind} {name}": (*bsdf(kind, color(name)), ("1e5", "-1e5", "1, 1e5, 1"), "from -10000 to 10000",
                          ("0", "1e4", "-1e4", "1e-30"))
       for kind in ("conductor", "roughconductor") for name in ("eta", "k")},
    **{f"{kind} {name}": (*bsdf(kind, color(name, UNSCALED)), ("-1", "1001", "1e30", "1, 1, 1e30"),
                          ("a colour must not be negative", "values up to 1000"), ("0", "1e-30", "1.5"))
       for kind, name in (("diffuse", "reflectance"), ("phong", "diffuseReflectance"),
                          ("phong", "specularReflectance"), ("conductor", "specularReflectance"),
                          ("roughconductor", "specularReflectance"), ("dielectric", "specularReflectance"),
                          ("dielectric", "specularTransmittance"), ("roughdielectric", "specularTransmittance"),
                          ("plastic", "diffuseReflectance"), ("plastic", "specularReflectance"),
                          ("roughplastic", "diffuseReflectance"), ("thindielectric", "specularTransmittance"),
                          ("difftrans", "transmittance"), ("roughdiffuse", "reflectance"),
                          ("ward", "diffuseReflectance"), ("ward", "specularReflectance"))},
    "mixture weights": (*bsdf("mixturebsdf",
                              text("weights").replace("{}", "1, {}") + 2 * BASE),
                        ("-1", "1001", "1e39"), ("from 0 to 1000", "too large"), ("0", "1000", "1e-30")),
    **{f"{kind} {name}": (*bsdf(kind, given + BASE), bad, says, good)
       for kind in ("coating", "roughcoating")
       for name, given, bad, says, good in (
           ("intIOR", text("intIOR"), ("0", "-1", "101"), "a refractive index from 0.01 to 100",
            ("0.01", "100", "1.0001")),
           ("extIOR", text("extIOR"), ("0", "bk7"), ("from 0.01 to 100", "must differ"), ("0.01", "100")),
           ("thickness", number("thickness") + color("sigmaA").format("1"), ("-1", "1e5"), "from 0 to 10000",
            ("0", "1e-30", "1e4")),
           ("sigmaA", color("sigmaA"), ("-1", "1e5", "0, 0, 1e5"), ("must not be negative", "values up to 10000"),
            ("0", "1e-30", "1e4")))},
    "roughcoating alpha": (*bsdf("roughcoating", number("alpha") + BASE), ("-1", "101"), "from 0 to 100",
                           ("0", "1e-30", "1", "100")),
    "coating specularReflectance": (*bsdf("coating", color("specularReflectance", UNSCALED) + BASE), ("-1", "1001"),
                                    ("a colour must not be negative", "values up to 1000"), ("0", "1e-30", "1.5")),
    "area radiance": (LAMP, f'<emitter type="area">{color("radiance")}</emitter>', ("-1", "1e39", "1, nan, 1"),
                      ("negative", "too large", "finite"), ("1e-30", "1e30")),
    "point intensity": (END, EMITTER.format("point", color("intensity")), ("-1", "1e39"), ("negative", "too large"),
                        ("0", "1e-30", "1e30")),
    "blackbody": (END, EMITTER.format("point", '<blackbody name="intensity" temperature="{}"/>'),
                  ("0", "-1", "1e39"), ("positive", "too large"), ("1", "1e30")),
    "spectrum": (END, EMITTER.format("point", '<spectrum name="intensity" value="400:1, 700:{}"/>'),
                 ("-1", "1e39"), ("negative", "too large"), ("0", "1e30")),
    "spot cutoffAngle": (END, EMITTER.format("spot", number("cutoffAngle")), ("0", "-1", "181"),
                         "from 0.001 to 180", ("0.001", "180")),
    "spot beamWidth": (END, EMITTER.format("spot", number("beamWidth")), ("-1", "21"), "from 0 to cutoffAngle",
                       ("0", "20")),
    "sky turbidity": (END, EMITTER.format("sky", number("turbidity")), ("0.5", "11"), "from 1 to 10", ("1", "10")),
    "sky stretch": (END, EMITTER.format("sky", number("stretch")), ("0.9", "2.1"), "from 1 to 2", ("1", "2")),
    "sky albedo": (END, EMITTER.format("sky", color("albedo")), ("-1", "1.1"), ("negative", "from 0 to 1"), ("0", "1")),
    "sky resolution": (END, EMITTER.format("sky", '<integer name="resolution" value="{}"/>'), ("7", "2049"),
                       "from 8 to 2048", ("8", "2048")),
    "sky hour": (END, EMITTER.format("sky", number("hour")), ("-1", "25"), "from 0 to 24", ("12",)),
    "sky scale": (END, EMITTER.format("sky", number("scale")), ("-1",), "not negative",
                  ("1e-30", "1e30")),
    "sun scale": (END, EMITTER.format("sun", number("scale")), ("-1",), "not negative",
                  ("1e-30", "1e25")),
    "sun sunRadiusScale": (END, EMITTER.format("sun", number("sunRadiusScale")), ("-1", "301"), "from 0 to 300",
                           ("0", "1e-4", "1e-3", "300")),
    "direction": (END, EMITTER.format("directional", '<vector name="direction" x="0" y="0" z="{}"/>'), ("0",),
                  "a vector that is not zero", ("-1e-30", "1e30")),
    "sphere radius": (SPHERE, number("radius"), ("0", "-1", "1e30"), ("must be positive", "1e+15"),
                      ("1e-12", "1e6")),
    "cylinder radius": (END, '<shape type="cylinder"><float name="radius" value="{}"/></shape></scene>',
                        ("0", "-1", "1e30"), ("must be positive", "1e+15"), ("1e-12", "1e6")),
    "scale": ('<scale value="2"/>', '<scale value="{}"/>', ("0", "1e30"), ("has no inverse", "1e+15", "too large"),
              ("1e-6", "1e6")),
    "fov": (SENSOR, number("fov"), ("0", "-1", "180", "1e-5", "360"), "from 0.0001 to 179.9", ("0.0001", "179.9")),
    "focalLength": (SENSOR, text("focalLength"), ("0mm", "-1mm", "1e-3mm", "1e30mm"), "from 0.05 mm to 20 km",
                    ("0.05mm", "50", "20000000mm")),
    "nearClip": (SENSOR, SENSOR + number("nearClip"), ("0", "-1", "1e31", "20000"), ("above 0 and up to", "farClip"),
                 ("1e-30", "1")),
    "farClip": (SENSOR, SENSOR + number("farClip"), ("0", "-1", "1e31", "1e-3"), ("above 0 and up to", "nearClip"),
                ("1e30",)),
    "width": (FILM, '<integer name="width" value="{}"/>', ("0", "-1", "2000000000", "70000", "99999999999"),
              ("from 1 to", "at most 65536", "too large an integer"), ("1", "300")),
    "crop": (FILM, FILM + '<integer name="cropWidth" value="{}"/>', ("0", "-1", "25", "2000000000"),
             "is not within the film's 24", ("1", "24")),
    "crop offset": (FILM, FILM + '<integer name="cropOffsetX" value="{}"/><integer name="cropWidth" value="1"/>',
                    ("-1", "24", "2147483647"), "is not within the film's 24", ("0", "23")),
    "box radius": (FILTER, f'<rfilter type="box">{number("radius")}</rfilter>', ("0", "0.4", "33"), "from 0.5 to 32",
                   ("0.5", "32")),
    "gaussian stddev": (FILTER, f'<rfilter type="gaussian">{number("stddev")}</rfilter>', ("0", "1e-20", "9"),
                        "from 0.125 to 8", ("0.125", "8")),
    "mitchell B": (FILTER, f'<rfilter type="mitchell">{number("B")}</rfilter>', ("-1", "1e20"), "from 0 to 1",
                   ("0", "1")),
    "sampleCount": (SENSOR, SENSOR + '<sampler type="independent"><integer name="sampleCount" value="{}"/></sampler>',
                    ("-1", "99999999999"), ("from 0 to", "too large an integer"), ("0", "2000000000")),
    "checkerboard scale": (*bsdf("diffuse", '<texture type="checkerboard" name="reflectance">' + number("uscale")
                                 + "</texture>"), (), "", ("0", "-1e30", "1e30", "1e-30")),
}
# Numbers that are none are refused whatever the parameter.
NOT_A_NUMBER = ("sphere radius", "fov", "roughconductor alpha", "phong exponent", "spot cutoffAngle", "box radius")


class Ranges(_h2mc.Test):
    def write_scene(self, old, new, value):
        self.assertEqual(_h2mc.SCENE.count(old) > 0, True, old)
        self.write("scene.xml", _h2mc.SCENE.replace(old, new.format(value), 1))

    def test_outside(self):
        for name, (old, new, refused, says, _) in RANGES.items():
            words = [says] if isinstance(says, str) else says
            for value in refused + (NUMBER if name in NOT_A_NUMBER else ()):
                with self.subTest(parameter=name, value=value):
                    self.write_scene(old, new, value)
                    message = self.fails(2, "info", "scene.xml").stderr
                    self.assertEqual(message.count("error:"), 1, message)
                    self.assertRegex(message, r"scene\.xml:\d+:\d+: error: ")
                    if value not in NUMBER:
                        self.assertTrue(any(word in message for word in words), message)

    def test_at_the_ends(self):
        for name, (old, new, _, _, accepted) in RANGES.items():
            for value in accepted:
                self.write_scene(old, new, value)
                for integrator in ("path", _h2mc.quick("h2mc")):
                    with self.subTest(parameter=name, value=value, integrator=integrator):
                        self.succeeds("render", "scene.xml", "-o", "out.exr", "-i", integrator, "-s", 2, "--width", 12,
                                      "--height", 8, "--stats", "stats.json")
                        self.assertEqual(self.report("stats.json")["statistics"]["not finite"], 0)


if __name__ == "__main__":
    _h2mc.main()
