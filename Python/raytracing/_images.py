"""Image files, how far images are from each other, tone curves, and shapes as seen from a point."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from . import _arguments, _core


def read_image(file: str | os.PathLike[str], layer: str = "") -> np.ndarray:
    """float32 (height, width, 3), or (height, width) of a file with one channel: linear, rows from the top. PNG, EXR,
    HDR, PFM, JPEG, BMP, TGA and, where the build has them, TIFF and WebP; layer: of an EXR file. Raises InputError."""
    return _core.read_image(_arguments.file("file", file), _arguments.text("layer", layer))


def write_image(file: str | os.PathLike[str], image: np.ndarray, description: str = "") -> None:
    """Writes float32 (height, width, 3) or (height, width) of linear values: .exr and .pfm bit for bit, .hdr, .png
    after clamping to [0, 1]; tonemap() brings radiance there. NaN becomes 0. description: kept in .png and .exr."""
    _core.write_image(_arguments.file("file", file), image, _arguments.text("description", description))


def metrics(image: np.ndarray, reference: np.ndarray) -> dict[str, float]:
    """Error figures over all pixels and channels of two linear images of one shape: mse, rmse, relmse (mean of
    (x - ref)^2 / (ref^2 + 0.01)), mae, psnr (dB, of clamped sRGB), max_abs. Raises InputError unless all is finite."""
    return _core.metrics(image, reference)


def flip_map(image: np.ndarray, reference: np.ndarray,
             pixels_per_degree: float = _core.flip_pixels_per_degree) -> np.ndarray:
    """FLIP (Andersson et al. 2020), (height, width) in [0, 1]: how different two linear images of one shape look to
    someone who flips between them; values are clamped to [0, 1] as on a screen, and one channel is grey."""
    return _core.flip_map(image, reference, _arguments.number("pixels_per_degree", pixels_per_degree))


def flip(image: np.ndarray, reference: np.ndarray, pixels_per_degree: float = _core.flip_pixels_per_degree) -> float:
    """The mean of flip_map()."""
    return float(flip_map(image, reference, pixels_per_degree).mean(dtype=np.float64))


def tonemap(image: np.ndarray, exposure: float = 0.0, curve: str = "none", encode: bool = True) -> np.ndarray:
    """Radiance as a screen shows it, in [0, 1]: exposure in stops and the curve, a value of the flag tonemap. encode:
    sRGB-encoded, for matplotlib and the like; False: linear, as write_image() takes for .png. NaN becomes 0."""
    return _core.tonemap(image, _arguments.number("exposure", exposure), _arguments.text("curve", curve), bool(encode))


def auto_exposure(image: np.ndarray) -> float:
    """Stops that bring the mean logarithm of the luminance to middle grey (Reinhard et al. 2002)."""
    return _core.auto_exposure(image)


def sample_spherical_triangle(a: np.ndarray, b: np.ndarray, c: np.ndarray,
                              u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Directions (N, 3) uniform in the solid angle of triangles with vertices a, b, c, (N, 3) each and relative to the
    point that sees them, by (N, 2) numbers u; and their density (N,) per steradian. A triangle without a solid
    angle, as one that is seen edge-on or has a vertex at the point, gives the direction (0, 0, 0) and the density 0.
    Arvo 1995, in the form of Peters 2021."""
    return _core.sample_spherical_triangle(a, b, c, u)


def triangle_solid_angle(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Solid angle (N,) in steradians of triangles as of sample_spherical_triangle(); 0 if a vertex is at the point. Van
    Oosterom & Strackee 1983."""
    return _core.triangle_solid_angle(a, b, c)


def devices() -> str:
    """What --list-devices of ray-tracing-gpu prints. Raises UsageError where the module has no GPU engine."""
    return _core.describe_devices()


def build() -> dict[str, Any]:
    """Version, what the module was built with, and whether it has the GPU engine."""
    return {"version": _core.version, "text": _core.version_text, "gpu": _core.has_gpu}
