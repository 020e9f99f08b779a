"""What light sampling does at a point: densities and light over the sphere of directions; and why a pixel is noisy."""

from __future__ import annotations

import json
import math
from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._arguments import instance, text, whole
from ._scene import Compiled


class Probe(NamedTuple):
    """A quantity over the directions at what a pixel shows. The map is a cylinder of equal areas: rows from +Y to -Y by the
    direction's height, columns as of sky images, with +X in the middle, so that every cell has one solid angle."""

    map: np.ndarray  #: (height, 2 height) float32: mean of each cell; of a density per steradian
    directions: np.ndarray  #: (height, 2 height, 3) unit: the middle of each cell
    position: np.ndarray  #: (3,) of the surface, world units
    normal: np.ndarray  #: (3,) unit, towards the camera
    wo: np.ndarray  #: (3,) unit, to the camera

    @property
    def integral(self) -> float:
        """Of the map over all directions; of a density 1, less what the strategy drops, as samples below the horizon."""
        return float(self.map.mean(dtype=np.float64)) * 4 * math.pi


def cell_directions(height: int) -> np.ndarray:
    """(height, 2 height, 3) unit directions of the middles of the cells of a Probe's map."""
    y = 1 - 2 * (np.arange(height) + 0.5) / height
    angle = 2 * math.pi * (np.arange(2 * height) + 0.5) / (2 * height)
    radius = np.sqrt(np.maximum(0, 1 - y * y))[:, None]
    return np.stack([-radius * np.cos(angle), np.broadcast_to(y[:, None], (height, 2 * height)),
                     -radius * np.sin(angle)], -1).astype(np.float32)


def _pixel(scene: Compiled, x: Any, y: Any) -> tuple[int, int]:
    instance("scene", scene, Compiled, "what Scene.compile() gives")
    return whole("x", x, 0, scene.width - 1), whole("y", y, 0, scene.height - 1)


def probe(scene: Compiled, x: int, y: int, strategy: str | int = "lights", height: int = 128, side: int = 4,
          show: str = "pdf", paths: int = 16, seed: int = 0) -> Probe:
    """The map of what a strategy does at the surface in the middle of pixel x, y of scene.compile().

    strategy: "bsdf"; "lights": a light is chosen and its shape sampled, by the flags that the scene was compiled for;
    the index of a light: its shape alone; "mixture" and "mis": half of either. show: "pdf", the strategy's density;
    "radiance", that arrives, its luminance; "product", of radiance, bsdf and cosine; "mis-weight", of a sample of the
    strategy against those of the other one. A cell's value is the mean over side * side places in it, or where rays
    are traced of as many paths, whose numbers follow from the seed. Raises ValueError where the pixel shows no surface,
    or one without a density, as mirrors. Ctrl-C ends it.
    """
    x, y = _pixel(scene, x, y)
    height, side = whole("height", height, 1, 4096), whole("side", side, 1, 64)
    paths, seed = whole("paths", paths, 1, 65536), whole("seed", seed, 0, 2**32 - 1)
    strategy, show = text("strategy", str(strategy)), text("show", str(show))
    values, place = _core.probe_map(scene._core, x, y, strategy, height, side, show, paths, seed)
    return Probe(values.reshape(height, 2 * height), cell_directions(height), *place)


def pixel_paths(scene: Compiled, x: int, y: int, samples: int = 256, sample: int | None = None) -> dict[str, Any]:
    """Why pixel x, y of scene.compile() is noisy, as `ray-tracing-image paths --json` tells: its samples, traced again
    as a render with the flags that the scene was compiled for traces them, their variance by how light was found
    ("techniques") and by bounces, and the brightest paths with densities, weights and lines; with `sample` all paths of
    that one, as "selected".
    """
    x, y = _pixel(scene, x, y)
    samples = whole("samples", samples, 1, 1 << 20)
    if sample is not None:
        sample = whole("sample", sample, 0, samples - 1)
    return json.loads(_core.pixel_paths(scene._core, x, y, samples, sample))
