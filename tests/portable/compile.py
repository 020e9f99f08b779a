#!/usr/bin/env python3
"""Compiles what a build folder compiles by another compiler, without linking: clang with LLVM's library of C++, or
MinGW for Windows.
    tests/portable/compile.py BUILD libc++|mingw [TARGET...]
MinGW has the headers of libraries from this system: what stands in another system's header is not seen. It compiles
libraries and programs; libc++ the tests as well. Prints what a compiler says; exit code 1 where one fails.
Targets: those of CMake; none: all.
"""
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import headers

# Warnings that GCC alone knows, and those of headers that are another system's here.
LIBCXX = ["-stdlib=libc++", "-Wno-unknown-warning-option", "-Wno-unqualified-std-cast-call"]
MINGW = ["x86_64-w64-mingw32-g++-posix", "-DNOMINMAX", "-DWIN32_LEAN_AND_MEAN",
         "-D_USE_MATH_DEFINES", "-Wno-attributes"]
# Parts of this build that another system has not: mpirun's library, and what Debian's libraries need of POSIX.
LEFT_OUT = re.compile(r"ray-tracing-mpi|rt-fault-|rt-docking|rt-record-layout|EmbreeCeiling")
OF_TESTS = re.compile(r"tests/|rt-[a-z]+-tests|rt-test-")


def newest_clang():
    """Of those that are installed: LLVM 14, Debian 12's usual one, has a library without ranges."""
    names = [path.name for folder in os.get_exec_path() for path in Path(folder).glob("clang++-*")]
    versions = [int(name[8:]) for name in names if name[8:].isdigit()]
    return f"clang++-{max(versions)}" if versions else "clang++"


def command_of(entry, compiler, folder):
    words = shlex.split(entry["command"])[1:]
    kept, skip = [], False
    for word in words:
        if skip:
            skip = False
        elif word in ("-o", "-MF", "-MT", "-include", "-isystem"):
            skip = True
        elif word not in ("-c", "-MD", "-Winvalid-pch") and not word.startswith("-DRT_HAS_EMBREE"):
            kept.append(word)
    if compiler == "mingw":
        folders = [folder, *(f"{folder}/{name}" for name in ("stb", "imgui", "OpenEXR", "Imath"))]
        return [*MINGW, *(word for place in folders for word in ("-isystem", place)), "-fsyntax-only", *kept]
    system = [word for path in re.findall(r"-isystem (\S+)", entry["command"]) for word in ("-isystem", path)]
    return [newest_clang(), *LIBCXX, "-fsyntax-only", *system, *kept]


def main(build, compiler, targets):
    commands = json.loads(Path(build, "compile_commands.json").read_text())
    wanted = [entry for entry in commands
              if not LEFT_OUT.search(entry["command"]) and not (compiler == "mingw" and OF_TESTS.search(entry["file"]))
              and (not targets or any(f"/{target}.dir/" in entry["command"] for target in targets))
              and not entry["file"].endswith("cmake_pch.hxx.cxx")]
    if not wanted:
        sys.exit("compile.py: nothing to compile")
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        headers.link_all(folder)
        results = pool.map(lambda entry: subprocess.run(command_of(entry, compiler, folder), cwd=entry["directory"],
                                                        stderr=subprocess.STDOUT, stdout=subprocess.PIPE, text=True,
                                                        check=False), wanted)
        failed = 0
        for entry, result in zip(wanted, results):
            failed += result.returncode != 0
            if result.returncode != 0:
                print(f"{entry['file']}:\n{result.stdout}", flush=True)
    print(f"{len(wanted) - failed} of {len(wanted)} compile by {compiler}")
    sys.exit(failed > 0)


main(sys.argv[1], sys.argv[2], sys.argv[3:])
