"""Scenes are nested dicts that can be edited and compiled again."""

import json
import math
import os
import pathlib
import tempfile
import unittest
import warnings

import numpy as np

import raytracing as rt
from support import error_of

SMALL = dict(width=24, spp=4, progress=False)


class Scenes(unittest.TestCase):
    def test_built_in(self):
        ids = [row["id"] for row in rt.scenes()]
        self.assertIn("cornell-box-lights", ids)
        scene = rt.load("cornell-box-lights")
        self.assertIn("look_from", scene["camera"])
        self.assertEqual(set(scene), set(scene.data))
        self.assertEqual(len(scene), len(scene.data))

    def test_unknown_name_fails_at_once(self):
        with self.assertRaisesRegex(rt.InputError, "no such scene"):
            rt.load("cornell-bux")
        self.assertIn("camera", rt.load("many-lights:20"))  # ids may have a number

    def test_dict_renders_as_what_it_was_made_from(self):
        for scene_id in ("cornell-box-lights", "one-weekend-final"):
            with self.subTest(scene=scene_id):
                scene = rt.load(scene_id)
                expected = rt.render(scene_id, "cpu", **SMALL).image
                scene.data  # becomes a dict, which is compiled in place of the id
                np.testing.assert_array_equal(rt.render(scene, "cpu", **SMALL).image, expected)
                np.testing.assert_array_equal(rt.render(dict(scene), "cpu", **SMALL).image, expected)

    def test_edited_and_compiled_again(self):
        scene = rt.load("cornell-box-lights")
        before = rt.render(scene, "cpu", **SMALL).image
        scene["camera"]["vertical_fov"] /= 2
        after = rt.render(scene, "cpu", **SMALL).image
        self.assertGreater(np.abs(after - before).max(), 0.01)
        scene["camera"]["vertical_fov"] *= 2
        np.testing.assert_array_equal(rt.render(scene, "cpu", **SMALL).image, before)

    def test_copies_are_apart(self):
        scene = rt.load("cornell-box-lights")
        other = rt.load(scene)
        other["camera"]["vertical_fov"] = 10
        self.assertNotEqual(scene["camera"]["vertical_fov"], 10)

    def test_numbers_of_numpy(self):
        scene = rt.load("cornell-box-lights")
        expected = rt.render(scene, "cpu", **SMALL).image
        scene["camera"]["look_from"] = np.array(scene["camera"]["look_from"])
        scene["camera"]["vertical_fov"] = np.float64(scene["camera"]["vertical_fov"])
        np.testing.assert_array_equal(rt.render(scene, "cpu", **SMALL).image, expected)
        with self.assertRaisesRegex(TypeError, "a scene holds dicts"):
            rt.render({"objects": [object()]}, "cpu")

    def test_saved_and_loaded(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.json"
            scene = rt.load("cornell-box-lights")
            scene["title"] = "Mine"
            scene.save(file)
            again = rt.load(file)
            self.assertEqual(again["title"], "Mine")
            np.testing.assert_array_equal(rt.render(again, "cpu", **SMALL).image,
                                          rt.render("cornell-box-lights", "cpu", **SMALL).image)

    def test_a_file_outlives_what_cannot_be_saved(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.json"
            rt.load("cornell-box-lights").save(file)
            before = file.read_text()
            for value, error, place in ((object(), TypeError, "a scene holds dicts"),
                                        (float("nan"), rt.InputError, "must be a finite number; got nan"),
                                        (-math.inf, rt.InputError, "must be a finite number; got -inf"),
                                        (np.float32("nan"), rt.InputError, "must be a finite number; got nan")):
                scene = rt.load(file)
                scene["objects"][0]["radius"] = value
                with self.assertRaisesRegex(error, f"^{file}: /objects/0/radius: {place}"):
                    scene.save(file)
                self.assertEqual(file.read_text(), before)
            self.assertEqual(os.listdir(folder), ["a.json"])
            with self.assertRaisesRegex(rt.RenderError, "no/a.json"):
                rt.load(file).save(pathlib.Path(folder) / "no" / "a.json")

    def test_what_no_scene_file_can_hold(self):
        def fault(change):
            data = json.loads(json.dumps(rt.load("cornell-box-lights").data))
            change(data)
            with self.assertRaises((TypeError, rt.InputError)) as caught:
                rt.load(data).compile()
            self.assertNotIn("\n", str(caught.exception))
            return str(caught.exception)

        def deepen(data):
            for _ in range(100000):
                data["a"] = data = {}

        self.assertEqual(fault(lambda d: d["objects"][0].update(radius=math.nan)),
                         "scene: /objects/0/radius: must be a finite number; got nan")
        self.assertEqual(fault(lambda d: d["camera"].update(look_from=np.array([0, np.inf, 0]))),
                         "scene: /camera/look_from/1: must be a finite number; got inf")
        self.assertEqual(fault(lambda d: d["objects"][0].update(more=d["objects"])),
                         "scene: /objects/0/more: must not contain itself")
        self.assertEqual(fault(lambda d: d["objects"][0].update({(1, 2): 3})),
                         "scene: /objects/0: names are texts, no tuple")
        self.assertRegex(fault(deepen), "^scene: /a/a/.*: values are nested deeper than 256$")
        self.assertEqual(rt.InputError("").exit_code, 3)

    def test_what_is_no_source(self):
        for source in (None, 5, ["a"]):
            with self.assertRaisesRegex(TypeError, "^scene: expected an id, a file, a dict or a Scene; got "):
                rt.load(source)
        for source in ("a\ud800.json", "cornell-box-lights\0x"):
            with self.assertRaisesRegex(ValueError, "^scene: expected a text of UTF-8 without NUL; got '[ -~]*'$"):
                rt.load(source)
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(rt.InputError, '": is a folder; allowed is an id'):
                rt.load(folder)
            other = pathlib.Path(folder) / "a.txt"
            other.write_text("furnace")
            with self.assertRaisesRegex(rt.InputError, '": is no file of a known kind; allowed is an id'):
                rt.load(other).compile()
            self.assertRegex(error_of("ray-tracing-image", "probe", folder, "1,1"), "is a folder; allowed is an id")

    def test_lights_and_materials_by_themselves(self):
        ball = {"type": "sphere", "center": [0, 2, 0], "radius": 1}
        for call, error in ((lambda: rt.light(None), "^shape: expected a dict, .*; got NoneType$"),
                            (lambda: rt.light(ball, emission=5), "^emission: expected three numbers; got int$"),
                            (lambda: rt.material(None), "^description: expected a dict, .*; got NoneType$")):
            with self.assertRaisesRegex(TypeError, error):
                call()
        self.assertEqual(rt.light(ball, np.full(3, 2.0)).lights[0]["emission"], (2, 2, 2))

    def test_files_beside_a_scene_file(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.json"
            (pathlib.Path(folder) / "a.obj").write_text("v 0 0 -3\nv 1 0 -3\nv 0 1 -3\nf 1 2 3\n")
            data = {"background": {"type": "constant", "color": [1, 1, 1]},
                    "materials": {"m": {"type": "lambertian", "albedo": [0.2, 0.2, 0.2]}},
                    "objects": [{"type": "mesh", "file": "a.obj", "material": "m"}]}
            file.write_text(json.dumps(data))
            scene = rt.load(file)
            self.assertEqual(scene.compile().primitives, (0, 0, 1))
            scene["title"] = "edited"
            self.assertEqual(scene.compile().primitives, (0, 0, 1))

    def test_errors_name_the_place(self):
        def broken(change):
            data = json.loads(json.dumps(rt.load("cornell-box-lights").data))
            change(data)
            return data

        changes = [
            (lambda d: d["camera"].update(vertical_fov=-1), "/camera/vertical_fov"),
            (lambda d: d["camera"].update(look_from=[0, "a", 0]), "/camera/look_from/1"),
            (lambda d: d["objects"][0].update(material="nothing"), "/objects/0/material"),
            (lambda d: d.update(nonsense=1), "nonsense"),
            (lambda d: d["objects"].append({"type": "sphere", "center": [0, 0, 0], "radius": -1, "material": "white"}),
             "radius"),
            (lambda d: d.pop("objects"), "objects"),
        ]
        for change, place in changes:
            with self.subTest(place=place), tempfile.TemporaryDirectory() as folder:
                data = broken(change)
                with self.assertRaises(rt.InputError) as caught:
                    rt.load(data).compile()
                self.assertIn(place, str(caught.exception))
                self.assertEqual(caught.exception.exit_code, 3)
                # The same words as of a file, but for its name.
                file = pathlib.Path(folder) / "a.json"
                file.write_text(json.dumps(data))
                expected = error_of("ray-tracing-cpu", "--headless", "--no-config", "--scene", file)
                self.assertEqual(str(caught.exception).split(":", 1)[1], expected.split(":", 1)[1])

    def test_notices_are_warnings(self):
        data = {"materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
                "objects": [{"type": "quad", "corner": [0, 0, -3], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0],
                             "material": "m"},
                            {"type": "mesh", "material": "m",
                             "positions": [0, 0, 0, 1, 0, 0, 2, 0, 0], "triangles": [0, 1, 2]}]}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            compiled = rt.load(data).compile()
        self.assertEqual([str(w.message) for w in caught], [f"{compiled.id}: {text}" for text in compiled.notices])
        self.assertGreater(len(caught), 0)

    def test_compiled(self):
        box = rt.load("cornell-box-lights").compile(width=30)
        self.assertEqual((box.width, box.height), (30, 30))
        self.assertEqual(box.id, "cornell-box-lights")
        self.assertGreater(len(box.lights), 0)
        self.assertGreater(sum(box.primitives), 5)
        self.assertAlmostEqual(sum(light["power_share"] for light in box.lights), 1, places=5)

    def test_kinds_of_lights(self):
        lamp = {"material": "lamp"}
        compiled = rt.load({
            "materials": {"lamp": {"type": "emitter", "emission": [1, 1, 1]}},
            "objects": [
                {"type": "sphere", "center": [0, 2, 0], "radius": 1, **lamp},
                {"type": "quad", "corner": [0, 5, 0], "edge_u": [1, 0, 0], "edge_v": [0, 0, 1], **lamp},
                {"type": "mesh", "positions": [0, 8, 0, 1, 8, 0, 0, 9, 0], "triangles": [0, 1, 2], **lamp},
                {"type": "disk", "center": [0, 11, 0], "normal": [0, 1, 0], "radius": 1, **lamp},
                {"type": "cylinder", "base": [0, 14, 0], "top": [0, 15, 0], "radius": 1, **lamp},
                {"type": "group", "transform": [{"scale": [1, 2, 1]}],
                 "objects": [{"type": "sphere", "center": [5, 2, 0], "radius": 1, **lamp}]},
                {"type": "point_light", "position": [0, 20, 0], "intensity": [1, 1, 1]},
                {"type": "spot_light", "position": [0, 21, 0], "direction": [0, -1, 0], "intensity": [1, 1, 1],
                 "inner_angle": 10, "outer_angle": 20},
                {"type": "directional_light", "direction": [0, -1, 0], "irradiance": [1, 1, 1]}]}).compile()
        kinds = {light["kind"] for light in compiled.lights}
        self.assertEqual(kinds, {"sphere", "quad", "triangle", "disk", "cylinder", "ellipsoid", "point", "spot",
                                 "directional"})


class Module(unittest.TestCase):
    def test_every_flag_is_a_keyword(self):
        text = rt.flags()
        for name in ("spp", "light_sampling", "denoise", "time_limit", "region"):
            self.assertRegex(text, rf"(?m)^{name} = ")
        self.assertRegex(rt.flags("gpu"), r"(?m)^device = ")

    def test_assets_are_found_from_any_folder(self):
        here = os.getcwd()
        try:
            os.chdir("/")
            rt.load("two-perlin-spheres" if any(r["id"] == "two-perlin-spheres" for r in rt.scenes()) else
                    "cornell-box-lights").compile()
        finally:
            os.chdir(here)

    def test_documented(self):
        for name in rt.__all__:
            with self.subTest(name=name):
                self.assertTrue(name == "DIMENSIONS" or getattr(rt, name).__doc__)


if __name__ == "__main__":
    unittest.main()
