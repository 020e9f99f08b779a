"""The commented examples of scene files: all are read without a notice, and show something."""

import json
import unittest
import warnings

import numpy as np

import raytracing as rt
from support import SOURCE

EXAMPLES = sorted((SOURCE / "Assets" / "examples").glob("*.json"))


class Examples(unittest.TestCase):
    def test_there_are_ten_with_comments(self):
        self.assertEqual([int(file.name[:2]) for file in EXAMPLES], list(range(1, 11)))
        for file in EXAMPLES:
            with self.subTest(file=file.name):
                scene = json.loads(file.read_text(encoding="utf-8"))
                self.assertGreaterEqual(len(scene["comment"]), 4)
                self.assertTrue(scene["title"])

    def test_each_is_lit(self):
        for file in EXAMPLES:
            with self.subTest(file=file.name):
                scene = rt.load(file)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", rt.Notice)
                    compiled = scene.compile()
                # Only what stands in for a missing file is worth a notice.
                self.assertEqual([notice for notice in compiled.notices if "stand" not in notice], [])
                image = rt.render(scene, "cpu", width=32, spp=8, quiet=True, progress=False).image
                self.assertTrue(np.isfinite(image).all())
                self.assertGreater(image.mean(), 0.02)
                self.assertGreater(image.std(), 0.02)

    def test_named_cameras(self):
        cameras = next(file for file in EXAMPLES if "cameras" in file.name)
        pictures = [rt.render(cameras, "cpu", width=24, spp=4, quiet=True, progress=False, camera=name).image
                    for name in (None, "close", "above")]
        for i, j in ((0, 1), (1, 2), (0, 2)):
            self.assertGreater(np.abs(pictures[i] - pictures[j]).max(), 0.1)

    def test_comments_are_lists_of_lines(self):
        scene = json.loads(EXAMPLES[0].read_text(encoding="utf-8"))
        for bad, place in (("a line", "/comment"), ([1], "/comment/0")):
            with self.subTest(comment=bad), self.assertRaisesRegex(rt.InputError, place):
                rt.load({**scene, "comment": bad}).compile()


if __name__ == "__main__":
    unittest.main()
