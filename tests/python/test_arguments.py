"""Arrays that are not as described are exceptions that name the argument and what is expected, for every function."""

import unittest

import numpy as np

import raytracing as rt
from support import numbers, unit, vector


def rows(*shape):
    return np.zeros(shape, np.float32)


class Arguments(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        box = rt.load("cornell-box-lights").compile(width=16)
        up = np.tile(unit(0, 1, 0), (4, 1))
        points, u = rows(4, 3), numbers(4, 2)
        picture = np.ones((4, 4, 3), np.float32)
        whole = np.arange(4, dtype=np.uint32)
        cls.functions = {
            "intersect": (box.intersect, dict(origins=points, directions=up, t_max=rows(4), time=rows(4))),
            "occluded": (box.occluded, dict(origins=points, directions=up, t_max=rows(4), time=rows(4))),
            "camera_rays": (box.camera_rays, dict(x=whole, y=whole, u_pixel=u, u_lens=u)),
            "sample_light": (box.sample_light, dict(light=0, points=points, normals=up, u=u, time=rows(4))),
            "light_pdf": (box.light_pdf, dict(light=0, points=points, normals=up, directions=up, time=rows(4))),
            "choose_light": (box.choose_light, dict(points=points, normals=up, u=u)),
            "light_probability": (box.light_probability, dict(light=0, points=points, normals=up)),
            "light_sampling_pdf": (box.light_sampling_pdf,
                                   dict(points=points, normals=up, directions=up, time=rows(4))),
            "sample_bsdf": (box.sample_bsdf, dict(material=0, normals=up, wo=up, u=u, uv=u)),
            "eval_bsdf": (box.eval_bsdf, dict(material=0, normals=up, wo=up, wi=up, uv=u)),
            "samples": (box.samples, dict(pixel=whole, sample=whole, dimension=whole, replicate=whole)),
            "sample_spherical_triangle": (rt.sample_spherical_triangle, dict(a=up, b=points, c=points, u=u)),
            "triangle_solid_angle": (rt.triangle_solid_angle, dict(a=up, b=points, c=points)),
            "metrics": (rt.metrics, dict(image=picture, reference=picture)),
            "flip_map": (rt.flip_map, dict(image=picture, reference=picture)),
            "tonemap": (rt.tonemap, dict(image=picture)),
            "auto_exposure": (rt.auto_exposure, dict(image=picture)),
            "write_image": (lambda image: rt.write_image("never.pfm", image), dict(image=picture)),
        }

    def for_each_array(self, change, kinds=(np.float32, np.uint32), images=True):
        """Calls each function once for each of its arrays, changed; the call must name the argument."""
        tried = 0
        for function, (call, arguments) in self.functions.items():
            for name, value in arguments.items():
                if not isinstance(value, np.ndarray) or value.dtype not in kinds or (value.ndim > 2 and not images):
                    continue
                with self.subTest(function=function, argument=name):
                    with self.assertRaises((TypeError, ValueError)) as caught:
                        call(**{**arguments, name: change(value)})
                    self.assertRegex(str(caught.exception), rf"^{name}: expected .*got ")
                    tried += 1
        self.assertGreater(tried, 15)

    def test_good_ones_pass(self):
        for function, (call, arguments) in self.functions.items():
            if function != "write_image":
                with self.subTest(function=function):
                    call(**arguments)

    def test_other_type(self):
        self.for_each_array(lambda a: a.astype(np.float64))
        self.for_each_array(lambda a: a.astype(np.int64))
        self.for_each_array(lambda a: a.astype(np.complex64))
        self.for_each_array(lambda a: a.astype(object))
        self.for_each_array(lambda a: a.astype("S3"))

    def test_other_byte_order(self):
        self.for_each_array(lambda a: a.astype(a.dtype.newbyteorder()))

    def test_no_array(self):
        for nothing in (None, "text", [[0.0, 0.0, 0.0]], object()):
            # None is a normal of a point in a medium.
            call, arguments = self.functions["sample_light"]
            with self.assertRaisesRegex(TypeError, "^points: expected"):
                call(**{**arguments, "points": nothing})
            with self.assertRaisesRegex(TypeError, "^image: expected"):
                rt.tonemap(nothing)

    def test_other_shape(self):
        self.for_each_array(lambda a: a[..., np.newaxis])
        self.for_each_array(lambda a: np.zeros((), a.dtype))
        self.for_each_array(lambda a: np.zeros((1,) * 6, a.dtype))

    def test_empty_image(self):
        with self.assertRaisesRegex(ValueError, "^image: expected sides from 1 to 16384"):
            rt.tonemap(rows(0, 4, 3))
        with self.assertRaisesRegex(ValueError, "^image: expected sides from 1 to 16384"):
            rt.tonemap(rows(1, 16385))

    def test_no_rows_give_none(self):
        call, arguments = self.functions["sample_light"]
        empty = {name: value[:0] if isinstance(value, np.ndarray) else value for name, value in arguments.items()}
        self.assertEqual(call(**empty).direction.shape, (0, 3))

    def test_not_contiguous(self):
        self.for_each_array(lambda a: np.repeat(a, 2, 0)[::2])
        self.for_each_array(lambda a: a[::-1])

    def test_fortran_order(self):
        call, arguments = self.functions["sample_light"]
        with self.assertRaisesRegex(ValueError, "^points: expected .*contiguous"):
            call(**{**arguments, "points": np.asfortranarray(arguments["points"])})

    def test_unaligned(self):
        bytes_of = np.zeros(4 * 3 * 4 + 1, np.uint8)
        unaligned = bytes_of[1:].view(np.float32).reshape(4, 3)
        call, arguments = self.functions["sample_light"]
        with self.assertRaisesRegex(ValueError, "^points: expected"):
            call(**{**arguments, "points": unaligned})

    def test_not_a_number(self):
        def poison(value):
            def change(a):
                a = a.copy()
                a.reshape(-1)[-1] = value
                return a
            return change

        self.for_each_array(poison(np.nan), kinds=(np.float32,), images=False)
        # An infinite distance is one.
        for function, (call, arguments) in self.functions.items():
            for name in ("points", "origins", "directions", "normals", "u", "wo", "wi", "a"):
                if name in arguments:
                    with self.subTest(function=function, argument=name), self.assertRaises(ValueError):
                        call(**{**arguments, name: poison(np.inf)(arguments[name])})

    def test_images_that_are_not_finite(self):
        picture = np.full((4, 4, 3), np.nan, np.float32)
        with self.assertRaises(rt.InputError):
            rt.metrics(picture, np.ones_like(picture))

    def test_not_of_length_one(self):
        box, arguments = self.functions["light_pdf"]
        for name in ("normals", "directions"):
            with self.assertRaisesRegex(ValueError, f"^{name}: expected vectors of length 1"):
                box(**{**arguments, name: 2 * arguments[name]})

    def test_numbers_outside_of_the_unit_square(self):
        call, arguments = self.functions["sample_light"]
        for bad in (1.0, -0.1):
            with self.assertRaisesRegex(ValueError, r"^u: expected numbers from 0 to below 1; got .* in row 2"):
                u = arguments["u"].copy()
                u[2, 0] = bad
                call(**{**arguments, "u": u})

    def test_counts_that_differ(self):
        call, arguments = self.functions["sample_light"]
        with self.assertRaisesRegex(ValueError, "^u: expected 4 rows, as many as points has, or one; got 3"):
            call(**{**arguments, "u": numbers(3, 2)})

    def test_one_row_for_all(self):
        call, arguments = self.functions["sample_light"]
        one = call(**{**arguments, "points": vector(0, 0, 0), "normals": unit(0, 1, 0), "time": 0.0})
        all_ = call(**arguments)
        for a, b in zip(one, all_):
            np.testing.assert_array_equal(a, b)

    def test_whole_numbers(self):
        call, arguments = self.functions["samples"]
        for bad in (-1, 2**32, 10**30):
            with self.assertRaisesRegex(ValueError, "^pixel: expected a whole number"):
                call(**{**arguments, "pixel": bad})
        with self.assertRaisesRegex(ValueError, "^x: expected pixels from 0 to 15; got 16"):
            self.functions["camera_rays"][0](16, 0)

    def test_indices(self):
        for function, name in (("sample_light", "light"), ("light_pdf", "light"), ("light_probability", "light"),
                               ("sample_bsdf", "material"), ("eval_bsdf", "material")):
            call, arguments = self.functions[function]
            for bad in (-1, 10**6):
                with self.assertRaisesRegex(ValueError, f"^{name}: expected an index from 0"):
                    call(**{**arguments, name: bad})
        with self.assertRaisesRegex(ValueError, "^material: expected one of .*; got no such"):
            self.functions["eval_bsdf"][0]("no such", *list(self.functions["eval_bsdf"][1].values())[1:])

    def test_a_scene_without_lights(self):
        dark = rt.material({"type": "lambertian", "albedo": [0.5, 0.5, 0.5]})
        with self.assertRaisesRegex(ValueError, "^scene: expected one with lights"):
            dark.choose_light(vector(0, 0, 0), None, numbers(1, 2))
        with self.assertRaisesRegex(ValueError, "^light: expected"):
            dark.sample_light(0, vector(0, 0, 0), None, numbers(1, 2))


if __name__ == "__main__":
    unittest.main()
