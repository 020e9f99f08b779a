"""Arrays that are not as described are exceptions that name the argument and what is expected, for every function."""

import unittest

import numpy as np

import raytracing as rt
from support import numbers, unit, vector


# What takes whole images, of which no row stands for others.
IMAGES = ("metrics", "flip_map", "tonemap", "auto_exposure", "write_image")


def rows(*shape):
    return np.zeros(shape, np.float32)


def one_row(argument):
    """The first row of an array, which is a number where rows are."""
    if not isinstance(argument, np.ndarray):
        return argument
    return argument[0].copy() if argument.ndim > 1 else argument[0].item()


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
        for function, (call, arguments) in self.functions.items():
            if function in IMAGES:
                continue
            with self.subTest(function=function):
                empty = {name: value[:0] if isinstance(value, np.ndarray) else value
                         for name, value in arguments.items()}
                results = call(**empty)
                for result in results if isinstance(results, tuple) else (results,):
                    self.assertEqual(len(result), 0)
        box = rt.load("cornell-box-lights").compile(width=16)
        nothing = np.zeros(0, np.uint32)
        self.assertEqual([a.shape for a in box.camera_rays(nothing, nothing)], [(0, 3), (0, 3)])

    def test_as_many_results_as_rows(self):
        # One row of all but one argument stands for as many as that one has.
        for function, (call, arguments) in self.functions.items():
            if function in IMAGES:
                continue
            for name, value in arguments.items():
                if not isinstance(value, np.ndarray):
                    continue
                with self.subTest(function=function, argument=name):
                    single = {key: one_row(a) if key != name else a for key, a in arguments.items()}
                    results = call(**single)
                    for result in results if isinstance(results, tuple) else (results,):
                        self.assertEqual(len(result), 4)

    def test_not_contiguous(self):
        self.for_each_array(lambda a: np.repeat(a, 2, 0)[::2])
        self.for_each_array(lambda a: a[::-1])

    def test_fortran_order(self):
        self.for_each_array(lambda a: np.asfortranarray(a) if a.ndim > 1 else np.repeat(a, 2)[::2])

    def test_transposed(self):
        self.for_each_array(lambda a: a.T if a.ndim > 1 else np.repeat(a, 2)[::2], images=False)
        with self.assertRaisesRegex(ValueError, "^image: expected"):
            rt.tonemap(np.ones((3, 5, 7), np.float32).T)

    def test_huge(self):
        # One row of memory that pretends to be more than any machine has, and more than a count of bytes can say.
        for count in (2**40, 2**59):
            self.for_each_array(lambda a: np.broadcast_to(a[:1], (count, *a.shape[1:])), images=False)
        with self.assertRaisesRegex(ValueError, "^image: expected"):
            rt.tonemap(np.broadcast_to(np.float32(1), (2**40, 4, 3)))

    def test_read_only_arrays_and_views_are_read(self):
        def frozen(a):
            whole = np.concatenate([a, a])
            whole.flags.writeable = False
            return whole[len(a):]

        for function, (call, arguments) in self.functions.items():
            if function == "write_image":
                continue
            with self.subTest(function=function):
                views = {name: frozen(value) if isinstance(value, np.ndarray) else value
                         for name, value in arguments.items()}
                self.assertEqual(repr(call(**views)), repr(call(**arguments)))

    def test_subclasses_of_arrays(self):
        masked = np.ma.masked_array(rows(4, 3), mask=True)
        call, arguments = self.functions["sample_light"]
        self.assertEqual(repr(call(**{**arguments, "points": masked})), repr(call(**arguments)))

    def test_largest_and_least_numbers(self):
        # What comes out need not make sense; that anything does is for the sanitizers.
        for value in (3.4e38, -3.4e38, 1e-45, -0.0):
            for function, (call, arguments) in self.functions.items():
                for name in ("origins", "points", "a", "b", "c", "uv", "image"):
                    if name in arguments and function != "write_image":
                        with self.subTest(function=function, argument=name, value=value):
                            call(**{**arguments, name: np.full_like(arguments[name], value)})
        for value in (0, 2**31, 2**32 - 1):
            for name, word in self.functions["samples"][1].items():
                u = self.functions["samples"][0](**{**self.functions["samples"][1], name: np.full_like(word, value)})
                self.assertTrue(((u >= 0) & (u < 1)).all())

    def test_any_arguments(self):
        # Mutations of several arguments at once, with a fixed seed: a result, or an error of these types.
        random = np.random.default_rng(56)
        mutations = [lambda a: a[:random.integers(0, 4)], lambda a: a[0], lambda a: a.T, lambda a: a[..., :1],
                     lambda a: a.astype(random.choice(["f2", "f8", ">f4", "i4", "u4", "?", "O", "c8"])), lambda a: None,
                     lambda a: a.tolist(), lambda a: np.full_like(a, random.choice([0, 1, 7])), lambda a: a[::-2],
                     lambda a: random.permuted(a), lambda a: np.broadcast_to(a[0], a.shape), lambda a: a[:0].copy(),
                     lambda a: a.reshape(-1), lambda a: random.choice([0.5, -1, 3, 2**40])]
        refused = 0
        for _ in range(150):
            for function, (call, arguments) in self.functions.items():
                if function == "write_image":
                    continue
                changed = {name: random.choice(mutations)(value)
                           if isinstance(value, np.ndarray) and random.random() < 0.4 else value
                           for name, value in arguments.items()}
                try:
                    call(**changed)
                except (TypeError, ValueError) as error:
                    refused += 1
                    names = "|".join((*arguments, "images differ"))
                    self.assertRegex(str(error), rf"^({names}|the {names})\b", function)
        self.assertGreater(refused, 500)

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
        for bad in (-1, 2**32, 10**30, -10**30):
            with self.assertRaisesRegex(ValueError, "^pixel: expected a whole number"):
                call(**{**arguments, "pixel": bad})
        with self.assertRaisesRegex(ValueError, "^x: expected pixels from 0 to 15; got 16"):
            self.functions["camera_rays"][0](16, 0)

    def test_numbers_of_numpy(self):
        call, arguments = self.functions["intersect"]
        near = call(**{**arguments, "t_max": 1.0})
        for one in (1, np.float32(1), np.float64(1), np.float16(1), np.int64(1), np.uint8(1)):
            self.assertEqual(repr(call(**{**arguments, "t_max": one})), repr(near))
        call, arguments = self.functions["samples"]
        self.assertEqual(repr(call(**{**arguments, "pixel": np.uint32(3)})), repr(call(**{**arguments, "pixel": 3})))

    def test_numbers_beyond_float(self):
        call, arguments = self.functions["intersect"]
        far = call(**{**arguments, "t_max": np.inf})
        for large in (1e300, 10**400):
            self.assertEqual(repr(call(**{**arguments, "t_max": large})), repr(far))
            for name, bad in (("t_max", -large), ("time", large), ("time", -large)):
                with self.assertRaisesRegex(ValueError, f"^{name}: expected numbers .*; got -?inf"):
                    call(**{**arguments, name: bad})
        for bad in (1j, "1", np.complex64(1), [1.0], np.datetime64("2026")):
            with self.assertRaisesRegex(TypeError, "^t_max: expected a number or a float32 array"):
                call(**{**arguments, "t_max": bad})

    def test_indices(self):
        for function, name in (("sample_light", "light"), ("light_pdf", "light"), ("light_probability", "light"),
                               ("sample_bsdf", "material"), ("eval_bsdf", "material")):
            call, arguments = self.functions[function]
            for bad in (-1, 10**6, 10**30, -10**30):
                with self.assertRaisesRegex(ValueError, f"^{name}: expected an index from 0 to .*; got {bad}$"):
                    call(**{**arguments, name: bad})
            for bad in (1.5, None, np.zeros(1, np.uint32)):
                with self.assertRaisesRegex(TypeError, f"^{name}: expected an index from 0 to .*; got "):
                    call(**{**arguments, name: bad})
            self.assertEqual(repr(call(**{**arguments, name: np.int64(0)})), repr(call(**arguments)))
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
