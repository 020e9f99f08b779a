"""What light sampling does at a point: the density of a strategy over the sphere of directions."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ._scene import Compiled


class Probe(NamedTuple):
    """The density of a strategy at what a pixel shows. The map is a cylinder of equal areas: rows from +Y to -Y by the
    direction's height, columns as of sky images, with +X in the middle, so that every cell has one solid angle."""

    map: np.ndarray  #: (height, 2 height) float32: mean density of each cell, per steradian
    directions: np.ndarray  #: (height, 2 height, 3) unit: the middle of each cell
    position: np.ndarray  #: (3,) of the surface, world units
    normal: np.ndarray  #: (3,) unit, towards the camera
    wo: np.ndarray  #: (3,) unit, to the camera

    @property
    def integral(self) -> float:
        """Of the map over all directions: 1, less what the strategy drops, as samples below the horizon."""
        return float(self.map.mean(dtype=np.float64)) * 4 * math.pi


def cell_directions(height: int, u: np.ndarray | None = None) -> np.ndarray:
    """(height, 2 height, 3) unit directions of the cells of a Probe's map, at the place u (2,) in each; the middle."""
    place = np.full(2, 0.5) if u is None else u
    y = 1 - 2 * (np.arange(height) + place[1]) / height
    angle = 2 * math.pi * (np.arange(2 * height) + place[0]) / (2 * height)
    radius = np.sqrt(np.maximum(0, 1 - y * y))[:, None]
    return np.stack([-radius * np.cos(angle), np.broadcast_to(y[:, None], (height, 2 * height)),
                     -radius * np.sin(angle)], -1).astype(np.float32)


def probe(scene: Compiled, x: int, y: int, strategy: str | int = "lights", height: int = 128, side: int = 4) -> Probe:
    """The map of what a strategy does at the surface in the middle of pixel x, y of scene.compile().

    strategy: "bsdf"; "lights": a light is chosen and its shape sampled, by the flags that the scene was compiled for;
    the index of a light: its shape alone; "mixture": half of either. A cell's density is the mean over side * side
    places in it. Raises ValueError where the pixel shows no surface.
    """
    if not (1 <= height <= 4096 and 1 <= side <= 64):
        raise ValueError(f"height, side: expected 1 to 4096 rows and 1 to 64 places; got {height}, {side}")
    if isinstance(strategy, str) and strategy not in ("bsdf", "lights", "mixture"):
        raise ValueError(f"strategy: expected bsdf, lights, mixture or the index of a light; got {strategy}")
    origins, rays = scene.camera_rays(x, y)
    hit = scene.intersect(origins, rays)
    if hit.material[0] < 0:
        raise ValueError(f"x, y: expected a pixel that shows a surface; got {x}, {y}, which shows none")
    wo = -rays[0]
    normal = hit.shading[0] if hit.normal[0] @ wo > 0 else -hit.shading[0]

    def bsdf(directions: np.ndarray) -> np.ndarray:
        return scene.eval_bsdf(int(hit.material[0]), hit.shading[0], wo, directions, hit.uv[0])[1]

    def lights(directions: np.ndarray) -> np.ndarray:
        pdf = (scene.light_sampling_pdf(hit.position[0], normal, directions) if isinstance(strategy, str) else
               scene.light_pdf(strategy, hit.position[0], normal, directions))
        return np.where(directions @ normal > 0, pdf, np.float32(0))

    total = np.zeros(2 * height * height)
    for place in np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2):
        directions = cell_directions(height, (place + 0.5) / side).reshape(-1, 3)
        if strategy == "bsdf":
            total += bsdf(directions)
        elif strategy == "mixture":
            total += 0.5 * bsdf(directions) + 0.5 * lights(directions)
        else:
            total += lights(directions)
    density = (total / side**2).astype(np.float32).reshape(height, 2 * height)
    return Probe(density, cell_directions(height), hit.position[0], normal, wo)
