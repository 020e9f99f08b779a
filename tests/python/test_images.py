"""Image files, metrics and tone curves."""

import pathlib
import tempfile
import unittest

import numpy as np

import raytracing as rt
from support import numbers


def picture(seed=1, scale=2.0):
    return numbers(12 * 10, 3, seed).reshape(12, 10, 3) * np.float32(scale)


class Files(unittest.TestCase):
    def test_round_trips(self):
        with tempfile.TemporaryDirectory() as folder:
            image = picture()
            for ending, tolerance in ((".pfm", 0), (".exr", 0), (".hdr", 0.02)):
                with self.subTest(ending=ending):
                    file = pathlib.Path(folder) / ("a" + ending)
                    rt.write_image(file, image)
                    np.testing.assert_allclose(rt.read_image(file), image, atol=tolerance)
            file = pathlib.Path(folder) / "a.png"
            rt.write_image(file, picture(scale=1))
            np.testing.assert_allclose(rt.read_image(file), picture(scale=1), atol=0.006)
            grey = np.ascontiguousarray(image[..., 0])
            rt.write_image(pathlib.Path(folder) / "grey.pfm", grey)
            np.testing.assert_array_equal(rt.read_image(pathlib.Path(folder) / "grey.pfm"), grey)

    def test_errors(self):
        with self.assertRaisesRegex(rt.InputError, "missing.png"):
            rt.read_image("missing.png")
        with self.assertRaises(rt.UsageError):
            rt.write_image("a.xyz", picture())
        with self.assertRaises(rt.RenderError):
            rt.write_image("no/such/folder/a.png", picture())

    def test_what_is_no_image(self):
        with tempfile.TemporaryDirectory() as folder:
            for ending in (".png", ".exr", ".hdr", ".pfm", ".jpg"):
                file = pathlib.Path(folder) / ("a" + ending)
                file.write_bytes(b"nothing of the kind")
                with self.subTest(ending=ending), self.assertRaises(rt.InputError):
                    rt.read_image(file)


class Metrics(unittest.TestCase):
    def test_by_numpy(self):
        image, reference = picture(1).astype(float), picture(2).astype(float)
        figures = rt.metrics(picture(1), picture(2))
        squared = (image - reference)**2
        self.assertAlmostEqual(figures["mse"], squared.mean(), places=6)
        self.assertAlmostEqual(figures["rmse"], squared.mean()**0.5, places=6)
        self.assertAlmostEqual(figures["relmse"], (squared / (reference**2 + 0.01)).mean(), places=5)
        self.assertAlmostEqual(figures["mae"], np.abs(image - reference).mean(), places=6)
        self.assertAlmostEqual(figures["max_abs"], np.abs(image - reference).max(), places=6)

    def test_flip(self):
        image = picture(1, 1)
        self.assertEqual(rt.flip(image, image), 0)
        black, white = np.zeros((20, 20, 3), np.float32), np.ones((20, 20, 3), np.float32)
        self.assertGreater(rt.flip(black, white), 0.9)
        self.assertEqual(rt.flip_map(black, white).shape, (20, 20))
        with self.assertRaisesRegex(ValueError, "^pixels_per_degree: "):
            rt.flip(black, white, 0)

    def test_flip_of_one_channel_is_that_of_grey(self):
        def flips(image, reference):
            return rt.flip_map(np.ascontiguousarray(image), np.ascontiguousarray(reference))

        image, reference = picture(1, 1)[..., 0], picture(2, 1)[..., 0]
        grey = flips(image, reference)
        np.testing.assert_array_equal(grey, flips(*(np.stack([i] * 3, -1) for i in (image, reference))))
        self.assertGreater(grey.min(), 0)
        self.assertEqual(flips(image, image).max(), 0)

    def test_sizes_that_differ(self):
        with self.assertRaises(rt.InputError):
            rt.metrics(picture(), picture()[:5].copy())


class ToneCurves(unittest.TestCase):
    def test_clamp_exposure_and_encoding(self):
        image = np.array([[[0.001, 0.25, 4]]], np.float32)
        np.testing.assert_allclose(rt.tonemap(image, encode=False), [[[0.001, 0.25, 1]]], rtol=1e-6)
        np.testing.assert_allclose(rt.tonemap(image, exposure=1, encode=False), [[[0.002, 0.5, 1]]], rtol=1e-6)
        encoded = 1.055 * 0.25**(1 / 2.4) - 0.055
        np.testing.assert_allclose(rt.tonemap(image), [[[0.001 * 12.92, encoded, 1]]], atol=1e-5)

    def test_every_curve_is_in_range(self):
        ramp = np.linspace(0, 50, 300, dtype=np.float32).reshape(10, 10, 3)
        for curve in ("none", "reinhard", "aces", "agx", "neutral"):
            with self.subTest(curve=curve):
                shown = rt.tonemap(ramp, curve=curve)
                self.assertTrue(((shown >= 0) & (shown <= 1)).all())
        with self.assertRaisesRegex(rt.UsageError, "^--tonemap filmic: must be"):
            rt.tonemap(ramp, curve="filmic")

    def test_not_a_number_is_black(self):
        image = np.full((2, 2, 3), np.nan, np.float32)
        image[0] = 0.5
        for curve in ("none", "reinhard", "aces", "agx", "neutral"):
            for encode in (True, False):
                shown = rt.tonemap(image, curve=curve, encode=encode)
                self.assertEqual((shown[1].min(), shown[1].max()), (0, 0))
                self.assertGreater(shown[0].min(), 0)

    def test_arguments(self):
        image = np.ones((2, 2, 3), np.float32)
        for call, error in ((lambda: rt.tonemap(image, exposure=None), "^exposure: expected a number; got NoneType$"),
                            (lambda: rt.tonemap(image, curve=None), "^curve: expected a text; got NoneType$"),
                            (lambda: rt.flip(image, image, "a"), "^pixels_per_degree: expected a number; got str$"),
                            (lambda: rt.write_image(None, image), "^file: expected the name of a file; got NoneType$"),
                            (lambda: rt.write_image("never.png", image, "\ud800"), "^description: expected a text of "),
                            (lambda: rt.write_image("a\0b.png", image), "^file: expected a text of UTF-8 without NUL")):
            with self.assertRaisesRegex((TypeError, ValueError), error):
                call()

    def test_auto_exposure(self):
        grey = np.full((8, 8, 3), 0.18, np.float32)
        self.assertAlmostEqual(rt.auto_exposure(grey) - rt.auto_exposure(4 * grey), 2, places=4)


if __name__ == "__main__":
    unittest.main()
