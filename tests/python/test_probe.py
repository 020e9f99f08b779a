"""Maps of densities over the sphere of directions integrate to one, and lie where lights are."""

import pathlib
import tempfile
import unittest

import numpy as np

import raytracing as rt
from support import run_program

ROOM = {
    "camera": {"look_from": [0, 1, 4], "look_at": [0, 0, 0], "vertical_fov": 40},
    "materials": {"floor": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]},
                  "lamp": {"type": "emitter", "emission": [9, 9, 9], "sides": "both"}},
    "objects": [
        {"type": "quad", "corner": [-5, 0, 5], "edge_u": [10, 0, 0], "edge_v": [0, 0, -10], "material": "floor"},
        {"type": "sphere", "center": [2, 2, 0], "radius": 0.7, "material": "lamp"},
        {"type": "quad", "corner": [-3, 2, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "material": "lamp"}],
}


class Probes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = rt.load(ROOM).compile(width=40)

    def test_maps_integrate_to_one(self):
        for strategy in ("bsdf", "lights", "mixture", "mis", 0, 1):
            with self.subTest(strategy=strategy):
                probe = rt.probe(self.scene, 20, 20, strategy)
                self.assertEqual(probe.map.shape, (128, 256))
                self.assertAlmostEqual(probe.integral, 1, delta=0.02)

    def test_where_lights_are(self):
        probe = rt.probe(self.scene, 20, 20, 0)
        to_center = np.array([2, 2, 0]) - probe.position
        distance = np.linalg.norm(to_center)
        inside = probe.directions @ (to_center / distance) > np.sqrt(1 - (0.7 / distance)**2)
        self.assertGreater((probe.map[inside] > 0).mean(), 0.98)
        # Cells at the rim are partly inside.
        self.assertLess((probe.map[~inside] > 0).mean(), 0.02)

    def test_below_the_surface_is_nothing(self):
        for strategy in ("bsdf", "lights", "mixture"):
            probe = rt.probe(self.scene, 20, 20, strategy)
            self.assertEqual(probe.map[probe.directions @ probe.normal < -0.02].max(), 0)

    def test_samples_follow_the_map(self):
        probe = rt.probe(self.scene, 20, 20, 1, height=32, side=8)
        u = np.random.default_rng(3).random((40000, 2), dtype=np.float32)
        s = self.scene.sample_light(1, probe.position, probe.normal, u)
        d = s.direction[s.pdf > 0]
        row = np.clip(((1 - d[:, 1]) / 2 * 32).astype(int), 0, 31)
        column = ((np.arctan2(d[:, 2], d[:, 0]) + np.pi) / (2 * np.pi) * 64).astype(int) % 64
        counts = np.bincount(row * 64 + column, minlength=2048)
        expected = probe.map.reshape(-1) * 4 * np.pi / 2048 * len(u)
        many = expected > 20
        chi_square = ((counts[many] - expected[many])**2 / expected[many]).sum()
        degrees = many.sum()
        # Rims are known to a place in 64 only, which adds to the statistic.
        self.assertLess(chi_square, degrees + 5 * np.sqrt(2 * degrees) + 0.5 * degrees)

    def test_maps_are_the_densities_of_the_formulas(self):
        probe = rt.probe(self.scene, 20, 20, "mixture", height=16, side=1)
        directions = probe.directions.reshape(-1, 3)
        above = directions @ probe.normal > 0
        lights = np.where(above, self.scene.light_sampling_pdf(probe.position, probe.normal, directions), 0)
        bsdf = self.scene.eval_bsdf("floor", probe.normal, probe.wo, directions)[1]
        np.testing.assert_allclose(probe.map.reshape(-1), (lights + bsdf) / 2, rtol=1e-4, atol=1e-6)

    def test_light_that_arrives(self):
        radiance = rt.probe(self.scene, 20, 20, show="radiance", height=64, paths=4)
        lamp = rt.probe(self.scene, 20, 20, 0, height=64)
        np.testing.assert_allclose(radiance.map[lamp.map > 0.9 * lamp.map.max()], 9, rtol=1e-4)
        self.assertEqual(radiance.map[radiance.directions @ radiance.normal < -0.1].max(), 0)
        product = rt.probe(self.scene, 20, 20, show="product", height=64, paths=4)
        cosine = np.maximum(product.directions @ product.normal, 0)
        inside = lamp.map > 0.9 * lamp.map.max()
        np.testing.assert_allclose(product.map[inside], (9 * 0.5 / np.pi * cosine)[inside], rtol=0.05)
        again = rt.probe(self.scene, 20, 20, show="product", height=64, paths=4)
        np.testing.assert_array_equal(product.map, again.map)

    def test_weights_of_both_strategies_are_one(self):
        lights = rt.probe(self.scene, 20, 20, "lights", height=32, side=1, show="mis-weight")
        bsdf = rt.probe(self.scene, 20, 20, "bsdf", height=32, side=1, show="mis-weight")
        np.testing.assert_allclose((lights.map + bsdf.map)[lights.directions @ lights.normal > 0.05], 1, rtol=1e-5)

    def test_it_is_that_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            scene, output = (str(pathlib.Path(folder) / name) for name in ("room.json", "map.pfm"))
            rt.load(ROOM).save(scene)
            done = run_program("ray-tracing-image", "probe", scene, "20,20", "--width", 40, "--strategy", "mis", "-o",
                               output)
            self.assertEqual(done.returncode, 0, done.stderr)
            np.testing.assert_array_equal(rt.read_image(output), rt.probe(self.scene, 20, 20, "mis").map)

    def test_what_is_no_scene(self):
        for call in (rt.probe, rt.pixel_paths):
            with self.assertRaisesRegex(TypeError, r"^scene: expected what Scene.compile\(\) gives; got str$"):
                call("cornell-box-lights", 1, 1)

    def test_what_is_no_place(self):
        with self.assertRaisesRegex(ValueError, "^x, y: expected a pixel that shows a surface"):
            rt.probe(self.scene, 0, 0)
        with self.assertRaisesRegex(ValueError, "^strategy: expected bsdf"):
            rt.probe(self.scene, 20, 20, "nothing")
        with self.assertRaisesRegex(ValueError, "^light: expected an index"):
            rt.probe(self.scene, 20, 20, 7)
        with self.assertRaisesRegex(ValueError, "^light: expected an index"):
            rt.probe(self.scene, 20, 20, -1)
        with self.assertRaisesRegex(ValueError, "^x: expected a whole number from 0 to 39; got 40"):
            rt.probe(self.scene, 40, 20)
        with self.assertRaisesRegex(ValueError, "^strategy: .* mirror or clear glass"):
            rt.probe(rt.load({**ROOM, "materials": {**ROOM["materials"], "floor": {
                "type": "metal", "albedo": [1, 1, 1], "fuzz": 0}}}).compile(width=40), 20, 20, "bsdf")
        with self.assertRaisesRegex(ValueError, "^height: expected"):
            rt.probe(self.scene, 20, 20, height=0)
        with self.assertRaisesRegex(ValueError, "^show: expected one of pdf, radiance"):
            rt.probe(self.scene, 20, 20, show="light")
        with self.assertRaisesRegex(ValueError, "^paths: expected"):
            rt.probe(self.scene, 20, 20, paths=0)


class PixelPaths(unittest.TestCase):
    def test_their_mean_is_the_pixel(self):
        scene = rt.load(ROOM)
        flags = {"width": 40, "spp": 32, "light_sampling": "bsdf", "seed": 3}
        found = rt.pixel_paths(scene.compile(**flags), 20, 20, samples=32, sample=5)
        pixel = rt.render(scene, **flags).image[20, 20]
        np.testing.assert_allclose(found["radiance"], pixel, rtol=1e-5)
        self.assertGreater(found["techniques"]["bsdf"]["share"], 0.9)
        self.assertEqual(len(found["luminance"]), 32)
        self.assertTrue(all(path["sample"] == 5 for path in found["selected"]))

    def test_what_is_no_sample(self):
        with self.assertRaisesRegex(ValueError, "^sample: expected"):
            rt.pixel_paths(rt.load(ROOM).compile(width=40), 20, 20, samples=8, sample=8)


if __name__ == "__main__":
    unittest.main()
