"""Samples and densities agree with each other and with integrals that do not use them."""

import itertools
import math
import re
import unittest

import numpy as np

import raytracing as rt
from support import SOURCE, numbers, sphere_directions, stratified, unit, vector

SIDE = 512  # strata a side, for integrals over directions
SPHERE_PDF = 1 / (4 * math.pi)

LIGHTS = {
    "sphere": {"type": "sphere", "center": [0.5, 2, 0.3], "radius": 0.7},
    "quad": {"type": "quad", "corner": [-0.5, 1.5, -1], "edge_u": [2, 0, 0.4], "edge_v": [-0.2, 0.1, 2]},
    "triangle": {"type": "mesh", "positions": [-1, 1.5, -1, 2, 1.2, 0.5, 0, 1.8, 1.5], "triangles": [0, 1, 2]},
}
STRATEGIES = {
    "sphere": [dict(sphere_light=s) for s in ("auto", "cone", "projected", "area")],
    "quad": [dict(quad_light=s) for s in ("auto", "solid-angle", "projected", "area")],
    "triangle": [dict(triangle_light=s) for s in ("auto", "solid-angle", "projected", "area")],
}
MATERIALS = {
    "lambertian": {"type": "lambertian", "albedo": [0.8, 0.6, 0.4]},
    "metal": {"type": "metal", "albedo": [0.9, 0.9, 0.9], "fuzz": 0.5},
    "principled": {"type": "principled", "base_color": [0.8, 0.5, 0.3], "metallic": 0.3, "roughness": 0.6},
    "coated": {"type": "principled", "base_color": [0.8, 0.5, 0.3], "roughness": 0.7, "clearcoat": 0.8,
               "clearcoat_roughness": 0.4},
}


def each_light():
    for kind, shape in LIGHTS.items():
        for flags in STRATEGIES[kind]:
            yield f"{kind} {flags}", rt.light(shape, sides="both", **flags)


class Lights(unittest.TestCase):
    points = np.array([[0, 0, 0], [1.5, -0.5, 0.7], [-2, 0.9, 0.1]], np.float32)

    def test_densities_integrate_to_one(self):
        """But for samples that cannot contribute, on the far side of a sphere or below the horizon."""
        directions = sphere_directions(stratified(SIDE))
        for name, light in each_light():
            for point, normal in itertools.product(self.points, (None, unit(0, 1, 0))):
                with self.subTest(light=name, point=point, normal=normal):
                    pdf = light.light_pdf(0, point, normal, directions)
                    if normal is not None:
                        pdf[directions @ normal <= 0] = 0
                    kept = (light.sample_light(0, point, normal, stratified(256)).pdf > 0).mean()
                    self.assertAlmostEqual(pdf.mean(dtype=float) / SPHERE_PDF, kept, delta=0.03)

    def test_density_of_a_sample_is_what_pdf_says(self):
        for name, light in each_light():
            for point, normal in itertools.product(self.points, (None, unit(0, 1, 0))):
                with self.subTest(light=name, point=point, normal=normal):
                    s = light.sample_light(0, point, normal, numbers(4000, 2))
                    used = s.pdf > 0
                    self.assertGreater(used.mean(), 0.2)
                    np.testing.assert_allclose(np.linalg.norm(s.direction[used], axis=1), 1, atol=1e-5)
                    pdf = light.light_pdf(0, point, normal, s.direction[used])
                    # At the rim rounding may let the direction miss, and densities by area are steep.
                    agree = np.isclose(pdf, s.pdf[used], rtol=5e-3)
                    self.assertGreater(agree.mean(), 0.98)
                    np.testing.assert_allclose(s.point[used], point + s.direction[used] * s.distance[used, None],
                                               atol=2e-4)

    def test_solid_angle_by_samples_and_by_brute_force(self):
        directions = sphere_directions(stratified(SIDE, 5))
        for name, light in each_light():
            for point in self.points:
                with self.subTest(light=name, point=point):
                    seen = np.isfinite(light.intersect(point, directions).t).mean() * 4 * math.pi
                    s = light.sample_light(0, point, None, numbers(100000, 2))
                    estimate = np.where(s.pdf > 0, 1 / np.maximum(s.pdf, 1e-30), 0)
                    error = 5 * estimate.std() / math.sqrt(len(estimate))
                    self.assertAlmostEqual(estimate.mean(), seen, delta=error + 0.01 * seen)

    def test_choice_follows_its_probabilities(self):
        for selection in ("contribution", "power", "uniform"):
            scene = rt.load("cornell-box-lights").compile(light_selection=selection)
            point, normal = vector(278, 100, 278), unit(0, 1, 0)
            with self.subTest(selection=selection):
                count = 50000
                light, probability = scene.choose_light(point, normal, numbers(count, 2))
                expected = np.array([scene.light_probability(i, point, normal)[0] for i in range(len(scene.lights))])
                self.assertAlmostEqual(expected.sum(), 1, places=4)
                np.testing.assert_allclose(probability, expected[light], rtol=1e-4)
                measured = np.bincount(light, minlength=len(expected)) / count
                np.testing.assert_array_less(np.abs(measured - expected),
                                             5 * np.sqrt(expected * (1 - expected) / count) + 1e-4)

    def test_all_lights_together_integrate_to_one(self):
        scene = rt.load("cornell-box-lights").compile()
        point = vector(278, 100, 278)
        directions = sphere_directions(stratified(1024))
        total = scene.light_sampling_pdf(point, None, directions).mean(dtype=float) / SPHERE_PDF
        self.assertAlmostEqual(total, 1, delta=0.05)

    def test_spherical_triangles(self):
        rng = np.random.default_rng(7)
        a, b, c = (rng.normal(size=(1000, 3)).astype(np.float32) for _ in range(3))
        angle = rt.triangle_solid_angle(a, b, c)
        # L'Huilier's theorem, in double.
        n = [v.astype(float) / np.linalg.norm(v, axis=1)[:, None] for v in (a, b, c)]
        sides = [np.arctan2(np.linalg.norm(np.cross(p, q), axis=1), (p * q).sum(1))
                 for p, q in ((n[1], n[2]), (n[2], n[0]), (n[0], n[1]))]
        half = sum(sides) / 2
        product = np.tan(half / 2) * np.prod([np.tan((half - side) / 2) for side in sides], axis=0)
        np.testing.assert_allclose(angle, 4 * np.arctan(np.sqrt(np.maximum(product, 0))), rtol=1e-3, atol=1e-5)
        direction, pdf = rt.sample_spherical_triangle(a, b, c, numbers(1000, 2))
        np.testing.assert_allclose(pdf * angle, 1, rtol=1e-5)
        np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1, atol=1e-5)
        # Within the planes through the edges.
        side = np.sign((n[0] * np.cross(n[1], n[2])).sum(1))
        for p, q in ((n[0], n[1]), (n[1], n[2]), (n[2], n[0])):
            self.assertGreater((side * (np.cross(p, q) * direction).sum(1)).min(), -1e-5)

    def test_triangles_of_any_size(self):
        a, b, c, u = vector(1, 0.1, 0), vector(0, 1, 0.2), vector(0.1, 0, 1), numbers(8, 2)
        angle = rt.triangle_solid_angle(a, b, c)
        direction, pdf = rt.sample_spherical_triangle(a, b, c, u)
        for size in (2.0**-120, 2.0**-60, 2.0**66, 2.0**126):
            factor = np.float32(size)
            np.testing.assert_array_equal(rt.triangle_solid_angle(a * factor, b * factor, c * factor), angle)
            scaled, density = rt.sample_spherical_triangle(a * factor, b * factor, c * factor, u)
            np.testing.assert_array_equal(scaled, direction)
            np.testing.assert_array_equal(density, pdf)
            # One vertex elsewhere on its ray.
            np.testing.assert_allclose(rt.triangle_solid_angle(a, b * factor, c), angle, rtol=1e-5)

    def test_triangles_without_a_solid_angle(self):
        zero, a, b = vector(0, 0, 0), vector(1, 0, 0), vector(0, 1, 0)
        for corners in ((zero, a, b), (a, zero, b), (a, b, zero), (zero, zero, zero), (a, a, a), (a, b, a)):
            for size in (1, 1e-45, 3e38):
                sized = [corner * np.float32(size) for corner in corners]
                self.assertEqual(rt.triangle_solid_angle(*sized), 0)
                direction, pdf = rt.sample_spherical_triangle(*sized, numbers(20, 2))
                self.assertEqual((np.abs(direction).max(), np.abs(pdf).max()), (0, 0))

    def test_triangles_of_any_numbers(self):
        random = np.random.default_rng(4)
        numbers_of = np.float32([0, -0.0, 1, -1, 0.5, 1e-45, -1e-38, 1e-30, 1e-20, 1e-10, 1e10, 1e20, -1e30, 3.4e38])
        a, b, c = random.choice(numbers_of, (3, 5000, 3))
        angle = rt.triangle_solid_angle(a, b, c)
        direction, pdf = rt.sample_spherical_triangle(a, b, c, numbers(5000, 2))
        self.assertTrue(((angle >= 0) & (angle < 2 * math.pi + 1e-5)).all())
        self.assertTrue((np.isfinite(direction).all(1) & (pdf >= 0)).all())
        length = np.linalg.norm(direction, axis=1)
        np.testing.assert_allclose(length[pdf > 0], 1, atol=1e-4)
        self.assertEqual(length[pdf == 0].max(), 0)

    def test_spherical_triangle_is_uniform(self):
        a, b, c = vector(1, 0.1, 0), vector(0, 1, 0.2), vector(0.1, 0, 1)
        direction, _ = rt.sample_spherical_triangle(a, b, c, stratified(300))
        middle = unit(1, 1, 1)
        inner = [(0.5 * v / np.linalg.norm(v) + 0.5 * middle).astype(np.float32) for v in (a, b, c)]
        share = rt.triangle_solid_angle(*inner)[0] / rt.triangle_solid_angle(a, b, c)[0]
        planes = [np.cross(inner[i], inner[(i + 1) % 3]) for i in range(3)]
        inside = np.all([(direction @ plane) > 0 for plane in planes], axis=0)
        self.assertAlmostEqual(inside.mean(), share, delta=0.003)

    def test_the_sky(self):
        point = vector(0, 0, 0)
        for row in rt.scenes():
            if "sky" not in row["id"] and "environment" not in row["id"]:
                continue
            scene = rt.load(row["id"]).compile()
            skies = [i for i, light in enumerate(scene.lights) if light["kind"] == "sky"]
            for sky in skies:
                with self.subTest(scene=row["id"]):
                    pdf = scene.light_pdf(sky, point, None, sphere_directions(stratified(1024)))
                    self.assertAlmostEqual(pdf.mean(dtype=float) / SPHERE_PDF, 1, delta=0.05)


class Bsdfs(unittest.TestCase):
    outgoing = [unit(0, 0, 1), unit(1, 0, 1), unit(1, 2, 0.4)]
    normal = unit(0, 0, 1)

    def test_densities_integrate_to_at_most_one(self):
        directions = sphere_directions(stratified(SIDE))
        for (name, description), wo in itertools.product(MATERIALS.items(), self.outgoing):
            with self.subTest(material=name, wo=wo):
                scene = rt.material(description)
                _, pdf = scene.eval_bsdf("material", self.normal, wo, directions)
                drawn = scene.sample_bsdf("material", self.normal, wo, stratified(SIDE))
                # What leaves below the surface is absorbed, and has no density.
                kept = (drawn.weight.max(1) > 0).mean()
                self.assertAlmostEqual(pdf.mean(dtype=float) / SPHERE_PDF, kept, delta=0.03)

    def test_albedo_by_samples_and_by_quadrature(self):
        directions = sphere_directions(stratified(SIDE))
        for (name, description), wo in itertools.product(MATERIALS.items(), self.outgoing):
            with self.subTest(material=name, wo=wo):
                scene = rt.material(description)
                value, _ = scene.eval_bsdf("material", self.normal, wo, directions)
                drawn = scene.sample_bsdf("material", self.normal, wo, stratified(SIDE))
                albedo = value.mean(0, dtype=float) / SPHERE_PDF
                np.testing.assert_allclose(drawn.weight.mean(0, dtype=float), albedo, atol=0.02)
                self.assertLess(albedo.max(), 1.02)

    def test_density_of_a_sample_is_what_eval_says(self):
        for (name, description), wo in itertools.product(MATERIALS.items(), self.outgoing):
            with self.subTest(material=name, wo=wo):
                scene = rt.material(description)
                drawn = scene.sample_bsdf("material", self.normal, wo, numbers(3000, 2))
                used = (drawn.pdf > 0) & (drawn.weight.max(1) > 0)
                value, pdf = scene.eval_bsdf("material", self.normal, wo, drawn.wi[used])
                agree = np.isclose(pdf, drawn.pdf[used], rtol=0.02)
                self.assertGreater(agree.mean(), 0.99)
                np.testing.assert_allclose((value / pdf[:, None])[agree], drawn.weight[used][agree], rtol=0.03,
                                           atol=1e-3)

    def test_mirror_and_glass(self):
        wo = unit(1, 0, 1)
        mirror = rt.material({"type": "metal", "albedo": [0.9, 0.8, 0.7], "fuzz": 0})
        drawn = mirror.sample_bsdf("material", self.normal, wo, numbers(10, 2))
        np.testing.assert_allclose(drawn.wi, np.tile(unit(-1, 0, 1), (10, 1)), atol=1e-6)
        np.testing.assert_allclose(drawn.weight, [[0.9, 0.8, 0.7]] * 10, rtol=1e-5)
        self.assertTrue(drawn.delta.all())
        self.assertEqual(mirror.eval_bsdf("material", self.normal, wo, unit(-1, 0, 1))[1][0], 0)
        glass = rt.material({"type": "dielectric", "ior": 1.5})
        drawn = glass.sample_bsdf("material", self.normal, wo, stratified(100))
        through = drawn.wi[drawn.transmitted]
        np.testing.assert_allclose(-through[:, 0], math.sin(math.radians(45)) / 1.5, atol=1e-5)  # Snell
        self.assertTrue((through[:, 2] < 0).all())

    def test_white_lambertian_is_the_cosine_over_pi(self):
        scene = rt.material({"type": "lambertian", "albedo": [1, 1, 1]})
        wi = sphere_directions(numbers(1000, 2))
        value, pdf = scene.eval_bsdf("material", self.normal, self.normal, wi)
        expected = np.maximum(wi[:, 2], 0) / math.pi
        np.testing.assert_allclose(value, np.repeat(expected[:, None], 3, 1), atol=1e-6)
        np.testing.assert_allclose(pdf, expected, atol=1e-6)


class Nothing(unittest.TestCase):
    """Rows that functions give for what there is none of are rows that the others take."""

    def test_directions_and_normals_of_zero(self):
        scene = rt.load("cornell-box-lights").compile(width=16)
        up, none = unit(0, 1, 0), vector(0, 0, 0)
        points = np.tile(vector(278, 100, 278), (3, 1))
        rows = np.array([up, none, up])
        for pdf in (scene.light_pdf(0, points, up, rows), scene.light_sampling_pdf(points, up, rows)):
            self.assertTrue(np.isfinite(pdf).all())
            self.assertEqual(pdf[1], 0)
        self.assertGreater(scene.light_sampling_pdf(points, up, rows)[0], 0)
        for normals, wo, wi in ((rows, up, up), (up, rows, up), (up, up, rows)):
            value, pdf = scene.eval_bsdf("white", normals, wo, wi)
            self.assertEqual((value[1].tolist(), pdf[1]), ([0, 0, 0], 0))
            self.assertGreater(pdf[[0, 2]].min(), 0)
        for normals, wo in ((rows, up), (up, rows)):
            drawn = scene.sample_bsdf("white", normals, wo, numbers(3, 2))
            self.assertEqual([float(np.abs(part[1]).max()) for part in drawn], [0] * 5)
            self.assertGreater(drawn.pdf[[0, 2]].min(), 0)
        self.assertEqual(scene.occluded(points, rows).tolist(), [True, False, True])
        self.assertEqual(scene.intersect(points, rows).kind.tolist()[1], -1)
        with self.assertRaisesRegex(ValueError, r"^directions: expected vectors of length 1 or 0; got .* in row 1$"):
            scene.light_pdf(0, points, up, np.array([up, 0.5 * up, up]))

    def test_formulas_of_the_guide(self):
        text = (SOURCE / "docs" / "python.md").read_text(encoding="utf-8")
        (block,) = re.findall(r"```python\n(import raytracing\n)?(box = .*?)```", text, re.S)
        count = 64
        up = np.tile(unit(0, 1, 0), (count, 1))
        given = {"raytracing": rt, "x": np.arange(count, dtype=np.uint32) % 8 * 8, "u": numbers(count, 2),
                 "y": np.arange(count, dtype=np.uint32), "to_light": up, "distance": 100.0, "points": np.zeros_like(up),
                 "normals": up, "directions": up, "wo": up, "wi": up, "pixel": 0, "sample": 0, "dimension": 0}
        exec(block[1], given)
        self.assertLess(given["s"].pdf.min(), 1e-9)  # there are rows with nothing to sample
        self.assertGreater(given["s"].pdf.max(), 0)


class Samplers(unittest.TestCase):
    def test_prefixes_of_sobol_are_strata(self):
        u = rt.samples(5, np.arange(256, dtype=np.uint32), 3, sampler="sobol", spp=256)
        for x, y in ((256, 1), (16, 16), (1, 256), (4, 64)):  # every elementary interval has one
            cells = (u[:, 0] * x).astype(int) * y + (u[:, 1] * y).astype(int)
            self.assertEqual(len(set(cells)), 256)

    def test_strata_have_one_each(self):
        u = rt.samples(9, np.arange(64, dtype=np.uint32), 4, sampler="stratified", spp=64)
        cells = (u[:, 0] * 8).astype(int) * 8 + (u[:, 1] * 8).astype(int)
        self.assertEqual(len(set(cells)), 64)

    def test_blue_noise_is_stratified_over_pixels(self):
        pixel = np.array([y * 64 + x for y in range(8) for x in range(8)], np.uint32)
        u = rt.samples(pixel, 0, 0, sampler="sobol-blue", spp=1, width=64, height=64)
        cells = (u[:, 0] * 8).astype(int) * 8 + (u[:, 1] * 8).astype(int)
        self.assertEqual(len(set(cells)), 64)

    def test_all_are_uniform_and_follow_the_seed(self):
        index = np.arange(4096, dtype=np.uint32)
        for sampler in ("sobol", "sobol-blue", "stratified", "independent"):
            with self.subTest(sampler=sampler):
                u = rt.samples(index, 0, 5, sampler=sampler, spp=16, width=64)
                counts = np.histogram2d(u[:, 0], u[:, 1], bins=8, range=((0, 1), (0, 1)))[0]
                self.assertLess(((counts - 64)**2 / 64).sum(), 63 + 5 * math.sqrt(2 * 63))
                self.assertTrue(((u >= 0) & (u < 1)).all())
                other = rt.samples(index, 0, 5, sampler=sampler, spp=16, width=64, seed=1)
                self.assertFalse(np.array_equal(u, other))

    def test_they_are_those_of_the_renderer(self):
        # A pinhole camera: the mean of what pixels see of a plane of known colours follows from where samples lie.
        scene = rt.load({"background": {"type": "gradient", "bottom": [0, 0, 0], "top": [1, 1, 1]},
                         "materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
                         "objects": [{"type": "sphere", "center": [0, 0, 99], "radius": 1, "material": "m"}]})
        image = rt.render(scene, "cpu", width=8, spp=4, sampler="sobol", progress=False).image
        compiled = scene.compile(width=8, spp=4, sampler="sobol")
        pixel = np.repeat(np.arange(64, dtype=np.uint32), 4)
        sample = np.tile(np.arange(4, dtype=np.uint32), 64)
        u = compiled.samples(pixel, sample, rt.DIMENSIONS["pixel"])
        _, directions = compiled.camera_rays(pixel % 8, pixel // 8, u)
        expected = (0.5 * (directions[:, 1] + 1)).reshape(64, 4).mean(1).reshape(8, 8)
        np.testing.assert_allclose(image[..., 0], expected, atol=1e-6)


if __name__ == "__main__":
    unittest.main()
