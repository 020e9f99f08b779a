"""Work in the module ends by Ctrl-C, and with the interpreter."""

import os
import pathlib
import signal
import tempfile
import time
import unittest

import raytracing as rt
from support import run_script


@unittest.skipIf(os.name == "nt", "signals of POSIX")
class Interrupted(unittest.TestCase):
    def interrupt(self, text):
        script = run_script(text)
        self.assertEqual(script.stdout.readline(), "begun\n")
        time.sleep(0.5)
        script.send_signal(signal.SIGINT)
        out, err = script.communicate(timeout=120)
        return script.returncode, out, err

    def test_render_raises(self):
        code, out, err = self.interrupt("""
            import raytracing
            try:
                print("begun", flush=True)
                raytracing.render("cornell-box-lights", "cpu", spp=10**8, progress=False)
            except KeyboardInterrupt:
                print("interrupted")
        """)
        self.assertEqual((code, out), (0, "interrupted\n"), err)

    def test_progressive_ends(self):
        code, out, err = self.interrupt("""
            import raytracing
            steps = raytracing.progressive("cornell-box-lights", "cpu", spp=10**8, width=100, progress=False, every=0.1)
            for step, film in enumerate(steps):
                if step == 0:
                    print("begun", flush=True)
            print(film.stopped_by, film.image.mean() > 0)
        """)
        self.assertEqual((code, out), (0, "interrupted True\n"), err)

    def test_probe_and_paths_end(self):
        for call in ("probe(c, 32, 50, 'mis', height=256, show='product', paths=65536)",
                     "pixel_paths(c, 32, 50, 2**20)"):
            code, out, err = self.interrupt(f"""
                import raytracing
                c = raytracing.load("cornell-box-lights").compile(width=64)
                print("begun", flush=True)
                try:
                    raytracing.{call}
                except KeyboardInterrupt:
                    print("interrupted")
            """)
            self.assertEqual((code, out), (0, "interrupted\n"), err)


class Exits(unittest.TestCase):
    """The interpreter ends while threads that it does not wait for are at work in the module."""

    def run_to_end(self, work, begun="time.sleep(1)"):
        script = run_script(f"""
            import threading, time, raytracing
            flags = dict(width=40, spp=10**8, threads=1, quiet=True)
            compiled = raytracing.load("cornell-box-lights").compile(width=64)
            films = []
            def work():
                {work}
            for _ in range(3):
                threading.Thread(target=work, daemon=True).start()
            {begun}
            print("ends")
        """)
        out, err = script.communicate(timeout=240)
        self.assertEqual((script.returncode, out, err), (0, "ends\n", ""))

    def test_renders(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.pfm"
            begin = f"films.append(raytracing.Film('cornell-box-lights', 'cpu', output={str(file)!r}, **flags))"
            self.run_to_end(f"{begin}; films[-1].run(); raytracing.render('cornell-box-lights', 'cpu', **flags)",
                            "while not films or films[0].progress == 0: time.sleep(0.01)")
            self.assertGreater(rt.read_image(file).mean(), 0)  # as by Ctrl-C

    def test_steps(self):
        self.run_to_end("for _ in raytracing.progressive('cornell-box-lights', 'cpu', every=0.01, **flags): pass")

    def test_formulas(self):
        self.run_to_end("while True: compiled.camera_rays(1, 1); raytracing.samples(0, 0, 0)")

    def test_long_work(self):
        self.run_to_end("raytracing.pixel_paths(compiled, 32, 50, 2**20)")

    @unittest.skipIf(not hasattr(os, "fork"), "no fork")
    def test_a_forked_process_waits_for_no_thread_of_its_parent(self):
        script = run_script("""
            import os, sys, threading, time, raytracing
            film = raytracing.Film("cornell-box-lights", "cpu", width=40, spp=10**8, threads=1)
            threading.Thread(target=film.run, args=(False,), daemon=True).start()
            time.sleep(0.5)
            child = os.fork()
            if child == 0:
                sys.exit(3)
            print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
        """)
        self.assertEqual(script.communicate(timeout=240)[0], "3\n")


if __name__ == "__main__":
    unittest.main()
