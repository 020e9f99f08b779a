"""Arrays of rays against scenes whose answers are known, and the camera's rays."""

import unittest

import numpy as np

import raytracing as rt
from support import numbers, sphere_directions, unit, vector

GREY = {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}, "n": {"type": "metal", "albedo": [0.9, 0.9, 0.9]}}


class Rays(unittest.TestCase):
    def test_spheres_by_their_equation(self):
        rng = np.random.default_rng(3)
        centers = rng.uniform(-5, 5, (20, 3)).round(3)
        radii = rng.uniform(0.3, 1, 20).round(3)
        scene = rt.load({"materials": GREY, "camera": {"look_from": [0, 0, 9], "look_at": [0, 0, 0]},
                         "objects": [{"type": "sphere", "center": list(c), "radius": r, "material": "m"}
                                     for c, r in zip(centers, radii)]}).compile()
        origins = rng.uniform(-8, 8, (5000, 3)).astype(np.float32)
        directions = sphere_directions(numbers(5000, 2))
        hits = scene.intersect(origins, directions)

        o, d = origins.astype(float)[:, None], directions.astype(float)[:, None]
        b = ((centers - o) * d).sum(-1)
        squared = b * b - ((centers - o)**2).sum(-1) + radii**2
        root = np.sqrt(np.maximum(squared, 0))
        t = np.where(b - root > 0, b - root, b + root)
        t[(squared < 0) | (t <= 0)] = np.inf
        nearest = t.min(1)
        agree = np.isclose(hits.t, nearest, rtol=1e-4, atol=1e-4) | (np.isinf(hits.t) & np.isinf(nearest))
        self.assertGreater(agree.mean(), 0.999)  # rays that graze may be either way
        hit = np.isfinite(hits.t) & agree
        self.assertGreater(hit.sum(), 200)
        np.testing.assert_array_equal(hits.kind[hit], 0)
        at = origins[hit] + directions[hit] * hits.t[hit, None]
        np.testing.assert_allclose(hits.position[hit], at, atol=1e-4)
        which = t[hit].argmin(1)
        np.testing.assert_allclose(hits.normal[hit] * radii[which, None], at - centers[which], atol=1e-3)

    def test_quad_and_triangle(self):
        scene = rt.load({"materials": GREY, "objects": [
            {"type": "quad", "corner": [-1, -1, -4], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0], "material": "m"},
            {"type": "mesh", "material": "n", "positions": [0, 0, -2, 0.5, 0, -2, 0, 0.5, -2],
             "triangles": [0, 1, 2]}]}).compile()
        hits = scene.intersect(np.array([[0.1, 0.2, 0], [0.6, 0.6, 0], [3, 0, 0]], np.float32), unit(0, 0, -1))
        np.testing.assert_allclose(hits.t[:2], [2, 4])
        self.assertEqual(list(hits.kind), [2, 1, -1])
        self.assertEqual([scene.materials[i] for i in hits.material[:2]], ["n", "m"])
        np.testing.assert_allclose(hits.uv[1], [0.8, 0.8], atol=1e-6)
        np.testing.assert_allclose(hits.normal[:2], [[0, 0, 1], [0, 0, 1]])
        self.assertEqual((np.isinf(hits.t[2]), hits.primitive[2], hits.material[2], hits.light[2]), (True, -1, -1, -1))
        ends = np.array([1.9, 3.9, 9], np.float32)
        self.assertTrue(np.isinf(scene.intersect(np.array([[0.1, 0.2, 0], [0.6, 0.6, 0], [3, 0, 0]], np.float32),
                                                 unit(0, 0, -1), ends).t).all())

    def test_any_agrees_with_nearest(self):
        for scene_id in ("cornell-box-lights", "one-weekend-final"):
            scene = rt.load(scene_id).compile()
            with self.subTest(scene=scene_id):
                x = np.random.default_rng(1).integers(0, scene.width, 3000).astype(np.uint32)
                y = np.random.default_rng(2).integers(0, scene.height, 3000).astype(np.uint32)
                origins, directions = scene.camera_rays(x, y, numbers(3000, 2))
                hits = scene.intersect(origins, directions)
                reached = np.isfinite(hits.t)
                np.testing.assert_array_equal(scene.occluded(origins, directions), reached)
                self.assertGreater(reached.sum(), 100)
                short = np.where(reached, hits.t * 0.99, 1e6).astype(np.float32)
                self.assertFalse(scene.occluded(origins[reached], directions[reached], short[reached]).any())

    def test_camera(self):
        scene = rt.load({"materials": GREY, "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1,
                                                         "material": "m"}],
                         "camera": {"look_from": [100, 2, 30], "look_at": [100, 2, 0], "vertical_fov": 90}})
        compiled = scene.compile(width=40, height=20)
        origins, directions = compiled.camera_rays(np.array([0, 39, 20], np.uint32), np.array([0, 19, 10], np.uint32),
                                                   np.array([[0, 0], [0.999999, 0.999999], [0, 0]], np.float32))
        np.testing.assert_allclose(origins, [[100, 2, 30]] * 3, rtol=1e-6)
        np.testing.assert_allclose(directions, [unit(-2, 1, -1), unit(2, -1, -1), unit(0, 0, -1)], atol=1e-5)

    def test_depth_is_that_of_the_render(self):
        scene = rt.load("cornell-box-lights")
        depth = rt.render(scene, "cpu", width=32, spp=16, progress=False).aov["depth"]
        compiled = scene.compile(width=32)
        x, y = (a.reshape(-1).astype(np.uint32) for a in np.meshgrid(np.arange(32), np.arange(32)))
        t = compiled.intersect(*compiled.camera_rays(x, y)).t.reshape(32, 32)
        slopes = np.gradient(np.where(np.isfinite(t), t, 1e9))
        smooth = np.isfinite(t) & (np.abs(slopes[0]) + np.abs(slopes[1]) < 20)
        self.assertGreater(smooth.sum(), 100)
        np.testing.assert_allclose(np.median(depth[smooth] / t[smooth]), 1, atol=0.01)

    def test_many_rays_of_odd_directions(self):
        scene = rt.load("one-weekend-final").compile()
        for axis in np.eye(3, dtype=np.float32):
            hits = scene.intersect(numbers(2049, 3) * 1e6, axis)
            self.assertEqual(hits.t.shape, (2049,))
        self.assertEqual(scene.intersect(vector(0, 1e30, 0), unit(0, 1, 0)).t.shape, (1,))


if __name__ == "__main__":
    unittest.main()
