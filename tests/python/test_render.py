"""Renders are those of the programs, with their texts; they can be watched, called off, and gone on with."""

import json
import pathlib
import tempfile
import threading
import time
import unittest

import numpy as np

import raytracing as rt
from support import error_of, run_program, run_script

SMALL = dict(width=40, spp=8, progress=False)


class SameAsTheProgram(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name):
        return str(pathlib.Path(self.folder.name) / name)

    def program_image(self, *arguments):
        result = run_program("ray-tracing-cpu", *arguments, "-o", self.file("p.pfm"), "--stats", self.file("p.json"),
                             "-q", "--no-config")
        self.assertEqual(result.returncode, 0, result.stderr)
        return rt.read_image(self.file("p.pfm"))

    def test_bits_of_scenes(self):
        for scene in ("cornell-box-lights", "one-weekend-final", "veach-mis", "cornell-smoke"):
            if not any(row["id"] == scene for row in rt.scenes()):
                continue
            with self.subTest(scene=scene):
                expected = self.program_image("--scene", scene, "--width", "40", "--spp", "8")
                film = rt.render(scene, "cpu", **SMALL)
                self.assertEqual((film.image.dtype, film.image.shape), (np.float32, expected.shape))
                np.testing.assert_array_equal(film.image, expected)

    def test_bits_with_flags(self):
        expected = self.program_image("--width=30", "--height=20", "--spp=5", "--seed=7", "--light-sampling=mixture",
                                      "--sampler=stratified", "--max-depth=4", "--replicates=2", "--region=3,4,10,8",
                                      "--one-sided-lights=off")
        film = rt.render("cornell-box-lights", "single", width=30, height=20, spp=5, seed=7, light_sampling="mixture",
                         quiet=True, sampler="stratified", max_depth=4, replicates=2, region=(3, 4, 10, 8),
                         one_sided_lights=False, progress=False)
        np.testing.assert_array_equal(film.image, expected)
        self.assertEqual(film.stats["engine"], "single")

    def test_statistics_have_the_names_of_the_file(self):
        self.program_image("--width", "40", "--spp", "8")
        expected = json.loads(pathlib.Path(self.file("p.json")).read_text(encoding="utf-8"))
        stats = rt.render("cornell-box-lights", "cpu", **SMALL).stats
        self.assertEqual(list(stats), list(expected))
        for name in ("spp_done", "scene_hash", "settings", "rays", "mean_radiance", "features", "kernel", "stopped_by"):
            if name == "rays":
                for ray in ("camera", "scattered", "shadow"):
                    self.assertEqual(stats[name][ray], expected[name][ray])
            else:
                self.assertEqual(stats[name], expected[name])

    def test_other_images(self):
        run = run_program("ray-tracing-cpu", "--width", "40", "--spp", "8", "--denoise", "--aov",
                          "albedo,normal,depth,variance,samples,emission", "-o", self.file("p.pfm"), "-q",
                          "--no-config")
        self.assertEqual(run.returncode, 0, run.stderr)
        film = rt.render("cornell-box-lights", "cpu", denoise=True, **SMALL)
        for name in ("albedo", "normal", "depth", "variance", "samples", "emission", "denoised"):
            with self.subTest(aov=name):
                np.testing.assert_array_equal(film.aov[name], rt.read_image(self.file(f"p.{name}.pfm")))
        np.testing.assert_array_equal(film.denoised, film.aov["denoised"])
        self.assertIn("wide-albedo", film.aov)
        self.assertEqual(len(film.aov), len(list(film.aov)))

    def test_files_that_flags_name(self):
        film = rt.render("cornell-box-lights", "cpu", output=[self.file("a.png"), pathlib.Path(self.file("a.pfm"))],
                         stats=self.file("a.json"), **SMALL)
        np.testing.assert_array_equal(rt.read_image(self.file("a.pfm")), film.image)
        shown = rt.tonemap(film.image, encode=False)
        self.assertLess(np.abs(rt.read_image(self.file("a.png")) - shown).max(), 0.01)
        self.assertEqual(json.loads(pathlib.Path(self.file("a.json")).read_text(encoding="utf-8"))["spp_done"], 8)

    def test_texts_of_errors(self):
        cases = [
            (dict(spp=0), ["--spp=0"]),
            (dict(spp="many"), ["--spp=many"]),
            (dict(width=99999), ["--width=99999"]),
            (dict(sampler="sobool"), ["--sampler=sobool"]),
            (dict(no_such_flag=1), ["--no-such-flag=1"]),
            (dict(region="1,2"), ["--region=1,2"]),
            (dict(region=(0, 0, 700, 700)), ["--region=0,0,700,700"]),
            (dict(features="spheres"), ["--features=spheres"]),
            (dict(device=0), ["--device=0"]),
            (dict(camera="nobody"), ["--camera=nobody"]),
            (dict(exposure=1000), ["--exposure=1000"]),
            (dict(reference="missing.exr"), ["--reference=missing.exr"]),
            (dict(resume="missing.rtc"), ["--resume=missing.rtc"]),
            (dict(output="a.xyz"), ["--output=a.xyz"]),
            (dict(output="no/such/folder/a.png"), ["--output=no/such/folder/a.png"]),
            (dict(scene="no-such-scene"), ["--scene=no-such-scene"]),
            (dict(scene="missing.json"), ["--scene=missing.json"]),
            (dict(adaptive=True, sampler="stratified"), ["--adaptive=on", "--sampler=stratified"]),
        ]
        for keywords, arguments in cases:
            with self.subTest(arguments=arguments):
                expected = error_of("ray-tracing-cpu", "--headless", "--no-config", "-q", *arguments)
                scene = keywords.pop("scene", "cornell-box-lights")
                with self.assertRaises(rt.Error) as caught:
                    rt.render(scene, "cpu", progress=False, **keywords)
                self.assertEqual(str(caught.exception), expected)
                self.assertIn(caught.exception.exit_code, (1, 2, 3))

    def test_what_is_of_the_programs_alone(self):
        for keywords in (dict(window=True), dict(list_scenes=True), dict(help=True), dict(quiet=3)):
            with self.subTest(keywords=keywords), self.assertRaises(rt.UsageError):
                rt.render("cornell-box-lights", "cpu", **keywords)
        with self.assertRaisesRegex(rt.UsageError, "^engine fast: must be auto, cpu, gpu, multi"):
            rt.render("cornell-box-lights", "fast")

    def test_arguments(self):
        film = rt.Film("cornell-box-lights", "cpu", width=8, spp=1)
        for call, error in ((lambda: film.aov[None], "^aov: expected a text; got NoneType$"),
                            (lambda: film.advance("a"), "^seconds: expected a number; got str$"),
                            (lambda: film.checkpoint("a\0b"), "^file: expected a text of UTF-8 without NUL"),
                            (lambda: rt.progressive("cornell-box-lights", every="a"), "^every: expected a number; "),
                            (lambda: film.run(cancel=5), r"^cancel: expected an object with is_set\(\), .*; got int$"),
                            (lambda: rt.render("cornell-box-lights", output="a\0b.png"),
                             r"^--output 'a\\x00b.png': must be a text of UTF-8 without NUL$")):
            with self.assertRaisesRegex((TypeError, ValueError), error):
                call()
        self.assertEqual(film.progress, 0)
        self.assertNotIn("nothing", film.aov)

    def test_checkpoint(self):
        whole = rt.render("cornell-box-lights", "cpu", width=40, spp=40, progress=False)
        half = rt.render("cornell-box-lights", "cpu", width=40, spp=21, progress=False)
        name = half.checkpoint(self.file("a.rtc"))
        rest = rt.render("cornell-box-lights", "cpu", width=40, spp=40, resume=name, progress=False)
        np.testing.assert_array_equal(rest.image, whole.image)
        with self.assertRaisesRegex(rt.UsageError, "^--checkpoint: "):
            half.checkpoint()
        with self.assertRaisesRegex(rt.InputError, "seed"):
            rt.render("cornell-box-lights", "cpu", width=40, seed=3, resume=name, progress=False)

    def test_a_command_that_it_names_makes_it_again(self):
        stats = rt.render("cornell-box-lights", "cpu", output=self.file("a.exr"), **SMALL).stats
        self.assertEqual(stats["app"], "ray-tracing-cpu")
        self.assertEqual(stats["outputs"], [self.file("a.exr")])


class Watched(unittest.TestCase):
    def test_pictures_own_their_memory(self):
        film = rt.render("cornell-box-lights", "cpu", **SMALL)
        image = film.image
        self.assertIs(image, film.image)
        self.assertFalse(image.flags.owndata)  # that of the film's own picture, which lives on with it
        kept = image.copy()
        del film
        np.testing.assert_array_equal(image, kept)

    def test_progressive(self):
        steps = [(film.progress, film.image.copy(), film.stopped_by)
                 for film in rt.progressive("cornell-box-lights", "cpu", every=0.02, width=100, spp=64, progress=False)]
        self.assertGreater(len(steps), 1)
        shares = [share for share, _, _ in steps]
        self.assertEqual(shares, sorted(shares))
        self.assertEqual((shares[-1], steps[-1][2]), (1.0, "spp"))
        whole = rt.render("cornell-box-lights", "cpu", width=100, spp=64, progress=False)
        np.testing.assert_array_equal(steps[-1][1], whole.image)

    def test_cancel_from_another_thread(self):
        film = rt.Film("cornell-box-lights", "cpu", width=200, spp=1000000)
        thread = threading.Thread(target=film.run, args=(False,))
        thread.start()
        while film.progress == 0:
            time.sleep(0.01)
        film.cancel()
        thread.join(60)
        self.assertFalse(thread.is_alive())
        self.assertEqual(film.stopped_by, "interrupted")
        self.assertGreater(film.image.mean(), 0)
        self.assertEqual(film.stats["stopped_by"], "interrupted")

    def test_cancel_by_an_event(self):
        event = threading.Event()
        threading.Timer(0.3, event.set).start()
        film = rt.render("cornell-box-lights", "cpu", width=100, spp=1000000, progress=False, cancel=event)
        self.assertEqual(film.stopped_by, "interrupted")

    def test_other_threads_run_meanwhile(self):
        film = rt.Film("cornell-box-lights", "cpu", width=200, spp=1000000, threads=1)
        counted = 0
        thread = threading.Thread(target=film.run, args=(False,))
        thread.start()
        end = time.monotonic() + 60
        while film.progress == 0 and time.monotonic() < end:
            time.sleep(0.01)
        for _ in range(1000):  # with the interpreter to itself, the render would let only one of these pass a slice
            counted += 1
        still_under_way = thread.is_alive()
        film.cancel()
        thread.join(60)
        self.assertTrue(still_under_way)
        self.assertEqual(counted, 1000)

    def test_what_a_failing_device_leaves_is_written(self):
        class Failing:
            written = 0

            def advance(self, seconds):
                raise rt.RenderError("the device is lost")

            def write(self):
                self.written += 1

        film = rt.Film("cornell-box-lights", "cpu", width=8, spp=1)
        film._core = Failing()
        with self.assertRaisesRegex(rt.RenderError, "^the device is lost$"):
            film.run(progress=False)
        self.assertEqual((film.stopped_by, film._core.written), ("failure", 1))

    def test_time_limit(self):
        film = rt.render("cornell-box-lights", "cpu", width=40, spp=2**31 - 1, time_limit=0.2, progress=False)
        self.assertEqual(film.stopped_by, "time_limit")


# What a script sees in a notebook, whose shell is derived from that of IPython's kernels; `shown`: what was displayed.
NOTEBOOK = """
            import sys, types
            shown, displays = [], 0
            class Handle:
                def update(self, html): shown.append(html)
            class ZMQInteractiveShell: pass
            class Shell(ZMQInteractiveShell): pass
            def display(html, display_id):
                global displays
                displays += 1
                shown.append(html)
                return Handle()
            ipython = types.ModuleType("IPython")
            ipython.get_ipython = lambda: Shell()
            ipython.display = types.SimpleNamespace(HTML=str, display=display)
            sys.modules["IPython"] = ipython
"""


class Bars(unittest.TestCase):
    def test_without_a_place_for_it(self):
        script = run_script("""
            import sys, raytracing
            sys.stderr = None
            for progress in (True, None):
                raytracing.render("cornell-box-lights", "cpu", spp=1, width=8, progress=progress)
            print("done")
        """)
        self.assertEqual(script.communicate(timeout=120), ("done\n", ""))

    def test_no_terminal_no_bar(self):
        script = run_script("""
            import raytracing
            raytracing.render("cornell-box-lights", "cpu", spp=4, width=40)
        """)
        self.assertEqual(script.communicate(timeout=120), ("", ""))

    def test_bar_that_is_asked_for(self):
        script = run_script("""
            import raytracing
            raytracing.render("cornell-box-lights", "cpu", spp=4, width=40, progress=True)
        """)
        _, err = script.communicate(timeout=120)
        self.assertRegex(err, r"^\n\[#+\] 4/4 spp  100%.*, done *\n$")

    def test_notebook(self):
        script = run_script(NOTEBOOK + """
            import raytracing
            raytracing.render("cornell-box-lights", "cpu", spp=4, width=40)
            print(shown[-1])
        """)
        out, err = script.communicate(timeout=120)
        self.assertEqual(err, "")
        self.assertRegex(out, r'^<progress value="100.0" max="100"></progress> <code>4/4 spp')

    def test_notebook_step_by_step(self):
        # One bar, which is updated in its place; it ends where the loop does.
        script = run_script(NOTEBOOK + """
            import raytracing
            steps = 0
            for film in raytracing.progressive("cornell-box-lights", "single", spp=10**6, width=300, every=0.25):
                steps += 1
                if steps == 3: film.cancel()
            print(len(shown) >= 3, displays, shown[0] != shown[-1], shown[-1].endswith("interrupted</code>"))
        """)
        out, err = script.communicate(timeout=120)
        self.assertEqual((out, err), ("True 1 True True\n", ""))

    def test_no_bar_in_a_shell_of_ipython_without_a_terminal(self):
        script = run_script(NOTEBOOK.replace("ZMQ", "Terminal") + """
            import raytracing
            raytracing.render("cornell-box-lights", "cpu", spp=4, width=40)
            print(shown)
        """)
        self.assertEqual(script.communicate(timeout=120), ("[]\n", ""))


if __name__ == "__main__":
    unittest.main()
