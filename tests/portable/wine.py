#!/usr/bin/env python3
"""Builds ray-tracing-cpu and ray-tracing-image for Windows by MinGW, runs them under Wine, and compares their pictures
and what they say with those of this system's programs.
    tests/portable/wine.py BUILD
BUILD holds this system's programs; those for Windows are built in BUILD/windows. They have no window, and no PNG, JPEG
nor OpenEXR, of which Debian has no libraries for MinGW (MinGW.cmake): pictures are PFM. Prints a line for each thing
that was tried; exit code 1 where one failed.
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import headers

ROOT = Path(__file__).resolve().parents[2]
CODECS = re.compile(r"png_|jpeg_|imath_|_Z\w*(Imf|Iex|Imath|IlmThread)_")
# Paths are the same, so that their noise is no difference. But libraries of C disagree in the last digit of sines and
# powers, which turns a path in some thousands aside. Of independent pictures relMSE is 0.01 to 10 in these scenes.
LARGEST_RELMSE = 1e-4
# One scene of each kind: lamps through glass, triangles, media and noise, textures by formula, many lights.
SCENES = {"cornell-box-lights": 32, "cornell-box-lucy": 24, "next-week-final": 32, "one-weekend-final": 48,
          "veach-mis": 48, "many-lights:1000": 32, "irradiance/quad.json": 16}


def run(*command, **options):
    return subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, **options)


def must(*command):
    result = run(*command)
    if result.returncode:
        sys.exit(f"wine.py: {' '.join(map(str, command))} failed:\n{result.stdout[-4000:]}")
    return result.stdout


def build_for_windows(folder):
    """The programs in folder/bin. What they would call of missing codecs is known when the library is compiled."""
    folder.mkdir(exist_ok=True)
    (folder / "headers").mkdir(exist_ok=True)
    stand_ins = folder / "libcodecs.a"
    must("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja",
         f"-DCMAKE_TOOLCHAIN_FILE={ROOT}/tests/portable/MinGW.cmake", f"-DRT_STANDINS={stand_ins}",
         f"-DRT_HEADERS={headers.link_all(folder / 'headers')}", "-DCMAKE_BUILD_TYPE=Release",
         "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG", "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=16",
         # GCC aligns stacks of Windows to 16 bytes, on which vectors of AVX would crash.
         "-DRT_KERNEL_ISAS=x86_64_v2", "-DRT_BUILD_GUI=OFF", "-DRT_BUILD_GPU=OFF", "-DRT_WITH_MPI=OFF",
         "-DRT_BUILD_PYTHON=OFF")
    must("cmake", "--build", folder, "--target", "rt-image")
    wanted = must("x86_64-w64-mingw32-nm", "--undefined-only", "--format=posix", folder / "librt-image.a")
    names = sorted({name for name in re.findall(r"^(\S+) U", wanted, re.MULTILINE) if CODECS.match(name)})
    source = folder / "codecs.s"
    source.write_text("\n".join([".text", *(f".globl {name}\n{name}:" for name in names), "ud2", ""]))
    must("x86_64-w64-mingw32-as", source, "-o", folder / "codecs.o")
    stand_ins.unlink(missing_ok=True)
    must("x86_64-w64-mingw32-ar", "crs", stand_ins, folder / "codecs.o")
    must("cmake", "--build", folder, "--target", "ray-tracing-cpu", "ray-tracing-image")
    return folder / "bin"


class Comparison:
    def __init__(self, own, windows, scratch):
        self.own, self.windows, self.scratch, self.failures = own, windows, scratch, 0
        self.environment = {**os.environ, "WINEPREFIX": str(scratch / "wine"), "WINEDEBUG": "-all",
                            "RT_ASSETS": str(ROOT / "Assets")}

    def both(self, program, *words, output=""):
        """Results here and under Wine; `output` is what the picture of each is called."""
        results = []
        for name, command in (("here", [self.own / program]), ("wine", ["wine", self.windows / f"{program}.exe"])):
            picture = ["-o", f"{name}-{output}"] if output else []
            results.append(run(*command, *words, *picture, cwd=self.scratch, env=self.environment))
        return results

    def check(self, what, passed, detail=""):
        print(f"{'passed' if passed else 'FAILED'}: {what}{'' if passed else ' ' + detail}", flush=True)
        self.failures += not passed

    def picture(self, scene, width):
        here, wine = self.both("ray-tracing-cpu", "--no-config", "-q", "--scene", scene, "--width", width, "--spp", 8,
                               output="picture.pfm")
        if here.returncode or wine.returncode:
            self.check(f"{scene} is rendered", False, wine.stdout[-500:])
            return
        difference = run(self.own / "ray-tracing-image", "diff", "--metric", "relmse", "here-picture.pfm",
                         "wine-picture.pfm", cwd=self.scratch).stdout.split()[-1]
        self.check(f"the pictures of {scene} are the same, relMSE {difference}", float(difference) <= LARGEST_RELMSE)

    def words(self, what, program, *words):
        here, wine = self.both(program, *words)
        same = here.returncode == wine.returncode and here.stdout == wine.stdout.replace("\r\n", "\n")
        self.check(what, same, f"{wine.returncode} where {here.returncode} is expected: {wine.stdout[-500:]}")


def main(build):
    build = Path(build).resolve()
    windows = build_for_windows(build / "windows")
    with tempfile.TemporaryDirectory() as scratch:
        compared = Comparison(build / "bin", windows, Path(scratch))
        run("wine", "cmd", "/c", "exit", env=compared.environment)  # it says what it sets up
        for scene, width in SCENES.items():
            compared.picture(scene, width)
        compared.words("--list-scenes is the same", "ray-tracing-cpu", "--list-scenes")
        compared.words("--help is the same", "ray-tracing-image", "--help")
        compared.words("a picture's description is the same", "ray-tracing-image", "info", "here-picture.pfm")
        compared.words("a missing file ends with the same line", "ray-tracing-cpu", "--no-config", "-q", "--scene",
                       "nothing.json", "-o", "x.pfm")
        compared.words("a wrong value ends with the same line", "ray-tracing-cpu", "--no-config", "--spp", "many")
    sys.exit(compared.failures > 0)


main(sys.argv[1])
