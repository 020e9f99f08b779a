"""What the tests of the Python module share: the programs to compare with, random numbers, directions."""

import os
import pathlib
import subprocess
import sys
import textwrap

import numpy as np

PROGRAMS = pathlib.Path(os.environ.get("RT_PROGRAM_DIR", "build/bin"))
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def run_program(name, *arguments):
    """The finished process of a program that has rendered without the user's files."""
    command = [str(PROGRAMS / name), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def error_of(name, *arguments):
    """The line with which a program ends, without its name."""
    return run_program(name, *arguments).stderr.strip().splitlines()[-1].split(": ", 1)[1]


def run_script(text, **kwargs):
    """A process of Python that runs a text, which may be indented."""
    return subprocess.Popen([sys.executable, "-c", textwrap.dedent(text)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, **kwargs)


def numbers(count, width, seed=1):
    return np.random.default_rng(seed).random((count, width), dtype=np.float32)


def stratified(side, seed=1):
    """side * side points of the unit square, one in each cell."""
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2)
    points = (grid + np.random.default_rng(seed).random(grid.shape)) / side
    return np.minimum(points, 1 - 2.0**-24).astype(np.float32)


def sphere_directions(u):
    """Uniform over all directions, density 1 / (4 pi)."""
    z = 1 - 2 * u[:, 0].astype(np.float64)
    radius = np.sqrt(np.maximum(0, 1 - z * z))
    angle = 2 * np.pi * u[:, 1].astype(np.float64)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], -1).astype(np.float32)


def vector(*components):
    return np.array(components, np.float32)


def unit(*components):
    v = np.array(components, np.float64)
    return (v / np.linalg.norm(v)).astype(np.float32)
