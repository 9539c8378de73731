# SPDX-License-Identifier: MIT
"""--confine: files that a scene refers to lie below a folder, or it is not read."""

import os

import _h2mc

OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"
INCLUDED = '<scene version="0.6.0"><bsdf type="diffuse" id="white"/></scene>'

# What a scene can say to have a file read; %s is its name. Each is right where the file is.
REFERENCES = {
    "included.xml": '<include filename="%s"/>',
    "mesh.obj": '<shape type="obj"><string name="filename" value="%s"/></shape>',
    "mesh.ply": '<shape type="ply"><string name="filename" value="%s"/></shape>',
    "picture.png": '<bsdf type="diffuse" id="b"><texture name="reflectance" type="bitmap">'
                   '<string name="filename" value="%s"/></texture></bsdf>'
                   '<shape type="sphere"><ref id="b"/></shape>',
    "sky.png": '<emitter type="envmap"><string name="filename" value="%s"/></emitter>',
    "curve.spd": '<shape type="sphere"><bsdf type="conductor"><spectrum name="eta" filename="%s"/>'
                 '<spectrum name="k" value="1"/></bsdf></shape>',
}
PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
3 0 1 2
"""


class Confine(_h2mc.Test):
    def setUp(self):
        super().setUp()
        for folder in ("in", "in/deeper", "inside", "out"):
            os.mkdir(self.path(folder))
        for folder in ("in", "in/deeper", "inside", "out"):
            for name, text in (("included.xml", INCLUDED), ("mesh.obj", OBJ), ("mesh.ply", PLY),
                               ("curve.spd", "400 1\n700 1.5\n")):
                self.write(f"{folder}/{name}", text)
            for name in ("picture.png", "sky.png"):
                self.write_png(f"{folder}/{name}", 2, 2, lambda x, y: (90, 90, 90))

    def scene(self, folder, reference, name, more=""):
        text = _h2mc.SCENE.replace("</scene>", more + REFERENCES[reference] % name + "</scene>")
        return self.write(f"{folder}/scene.xml", text)

    def refused(self, scene, *says, confine="in"):
        self.fails(2, "info", scene, "--confine", confine,
                   says=("is outside of", f'"{os.path.realpath(self.path(confine))}"', *says))

    def test_every_kind_of_file(self):
        for reference in REFERENCES:
            with self.subTest(reference):
                for name in (reference, f"deeper/{reference}", f"./deeper/../{reference}",
                             self.path(f"in/{reference}")):
                    self.succeeds("info", self.scene("in", reference, name), "--confine", "in")
                # "inside" begins as "in" does, and is not below it.
                for name in (f"../out/{reference}", f"../inside/{reference}",
                             f"deeper/../../out/{reference}", self.path(f"out/{reference}")):
                    scene = self.scene("in", reference, name)
                    self.succeeds("info", scene)
                    self.refused(scene, f"out/{reference}" if "out" in name else reference,
                                 "in/scene.xml:")

    def test_symbolic_links(self):
        os.symlink(self.path("out"), self.path("in/folder"))
        os.symlink("../in/deeper", self.path("in/harmless"))
        os.symlink(self.path("in"), self.path("alias"))
        for reference in REFERENCES:
            with self.subTest(reference):
                os.symlink(f"../out/{reference}", self.path(f"in/link-{reference}"))
                for name in (f"link-{reference}", f"folder/{reference}"):
                    scene = self.scene("in", reference, name)
                    self.succeeds("info", scene)
                    self.refused(scene, name)
                self.succeeds("info", self.scene("in", reference, f"harmless/{reference}"), "--confine", "in")
                self.succeeds("info", self.scene("in", reference, reference), "--confine", "alias")

    def test_search_folders_and_includes(self):
        self.write("in/only.xml", '<scene version="0.6.0"><include filename="../out/included.xml"/></scene>')
        self.write("in/deeper/scene.xml", _h2mc.SCENE.replace(
            "</scene>", '<include filename="../only.xml"/></scene>'))
        self.refused("in/deeper/scene.xml", "only.xml:1:", "out/included.xml")
        self.write("out/rare.obj", OBJ)
        scene = self.scene("in", "mesh.obj", "rare.obj", more='<path value="../out"/>')
        self.succeeds("info", scene)
        self.refused(scene, "rare.obj")

    def test_nothing_is_told_about_other_folders(self):
        self.write("out/secret.obj", OBJ)
        scene = self.scene("in", "mesh.obj", "../out/secre.obj")
        self.assertIn("secret.obj", self.fails(2, "info", scene).stderr)
        self.refused(scene)
        result = self.run_h2mc("info", scene, "--confine", "in")
        self.assertNotIn("secret.obj", result.stderr)

    def test_every_command(self):
        scene = self.scene("in", "mesh.obj", "../out/mesh.obj")
        for arguments in (["render", scene, "-o", "a.exr"], ["stress", scene], ["gradcheck", scene],
                          ["inspect", scene, "--pixel", "3,3", "-o", "page"],
                          ["compare", scene, "-o", "page"]):
            with self.subTest(arguments):
                self.fails(2, *arguments, "--confine", "in", says=("is outside of", "mesh.obj"))

    def test_scene_outside(self):
        """The scene itself was named by the user."""
        self.succeeds("info", self.scene("out", "mesh.obj", "../in/mesh.obj"), "--confine", "in")
        self.refused(self.scene("out", "mesh.obj", "mesh.obj"))

    def test_no_such_folder(self):
        self.fails(2, "info", self.scene("in", "mesh.obj", "mesh.obj"), "--confine", "nowhere",
                   says=("--confine", "nowhere"))


if __name__ == "__main__":
    _h2mc.main()
