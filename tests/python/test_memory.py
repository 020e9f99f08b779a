"""Loops of calls keep no memory, and the module needs neither a window nor a device."""

import ctypes
import gc
import os
import subprocess
import sys
import unittest

import numpy as np

import raytracing as rt
from support import numbers, unit

# Of all calls of a loop together: less than the film of each render, of 24 x 24 pixels and 24 bytes each, would leave.
KEPT_BYTES = 4 << 20


# Of each call, on average: less than one pointer that is kept for it.
KEPT_BYTES_PER_CALL = 8


class _MallInfo(ctypes.Structure):
    """struct mallinfo2 of glibc 2.33, mallinfo(3)."""

    _fields_ = [(name, ctypes.c_size_t) for name in
                ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks", "fordblks",
                 "keepcost")]


def bytes_in_use():
    """Of all that was allocated and not freed, or None where the library of C does not tell."""
    tell = getattr(ctypes.CDLL(None), "mallinfo2", None)
    if tell is None:
        return None
    tell.restype = _MallInfo
    info = tell()
    return info.uordblks + info.hblkhd


def resident_bytes():
    with open("/proc/self/statm", encoding="ascii") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@unittest.skipUnless(sys.platform == "linux", "asks /proc how much memory there is")
@unittest.skipIf("RT_SANITIZED" in os.environ, "a sanitizer keeps what is freed for a while")
class Leaks(unittest.TestCase):
    def assert_flat(self, call, warm_up, calls):
        for _ in range(warm_up):
            call()
        gc.collect()
        before = resident_bytes()
        for _ in range(calls):
            call()
        gc.collect()
        self.assertLess(resident_bytes() - before, KEPT_BYTES)

    def test_renders(self):
        scene = rt.load("cornell-box-lights")
        self.assert_flat(lambda: rt.render(scene, "single", width=24, spp=1, max_depth=2, quiet=True).image,
                         500, 2000)

    def test_nothing_at_all_is_kept_of_a_render(self):
        # What grows by doubling is the same for a while: between two counts it must have doubled.
        if not bytes_in_use():
            self.skipTest("the library of C does not tell what is in use")
        scene = rt.load("cornell-box-lights")

        def render():
            rt.render(scene, "single", width=4, height=4, spp=1, max_depth=1, quiet=True).image

        for _ in range(1000):
            render()
        gc.collect()
        before, calls = bytes_in_use(), 4000
        for _ in range(calls):
            render()
        gc.collect()
        self.assertLess(bytes_in_use() - before, KEPT_BYTES_PER_CALL * calls)

    def test_renders_of_scenes_that_are_compiled_each_time(self):
        def call():
            scene = rt.load("cornell-box-lights")
            scene["title"] = "again"
            film = rt.render(scene, "single", width=24, spp=2, denoise=True, max_depth=2, quiet=True)
            film.denoised, film.aov["normal"], film.stats

        self.assert_flat(call, 100, 400)

    def test_errors(self):
        scene = rt.load("cornell-box-lights").compile()

        def call():
            for bad in (np.zeros((3, 2), np.float32), np.full((3, 3), np.nan, np.float32), None):
                with self.assertRaises((TypeError, ValueError)):
                    scene.intersect(bad, unit(0, 0, 1))
            with self.assertRaises(rt.UsageError):
                rt.render("cornell-box-lights", "cpu", spp=0)

        self.assert_flat(call, 200, 2000)

    def test_arrays(self):
        scene = rt.load("cornell-box-lights").compile()
        points, u = numbers(20000, 3), numbers(20000, 2)
        self.assert_flat(lambda: (scene.sample_light(0, points, None, u), scene.intersect(points, unit(0, 0, 1))),
                         20, 200)


class Alone(unittest.TestCase):
    def test_neither_display_nor_driver(self):
        environment = {**os.environ, "VK_DRIVER_FILES": "/nonexistent", "VK_ICD_FILENAMES": "/nonexistent"}
        for name in ("DISPLAY", "WAYLAND_DISPLAY"):
            environment.pop(name, None)
        script = ("import raytracing; film = raytracing.render('cornell-box-lights', width=8, spp=1); "
                  "print(film.stats['app'], film.image.shape)")
        result = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True,
                                check=False)
        self.assertEqual((result.stdout, result.stderr), ("ray-tracing-cpu (8, 8, 3)\n", ""))

    @unittest.skipUnless(sys.platform == "linux", "asks the loader's tool")
    def test_no_library_of_windows(self):
        libraries = subprocess.run(["ldd", rt._core.__file__], capture_output=True, text=True, check=True).stdout
        for name in ("libglfw", "libimgui", "libX11", "libmpi"):
            self.assertNotIn(name, libraries)

    def test_a_module_without_the_gpu_says_so(self):
        if rt.build()["gpu"]:
            self.skipTest("this one has it")
        with self.assertRaisesRegex(rt.UsageError, "built without the GPU engine"):
            rt.render("cornell-box-lights", "gpu")


if __name__ == "__main__":
    unittest.main()
