"""Pictures and charts of the guide's notebooks, without any library for plots: PNG files and SVG files.

A notebook shows what these functions return. run.py sets where files go; in Jupyter none are written.
"""

from __future__ import annotations

import html
import math
import os
import pathlib
import tempfile
from typing import Any, Mapping

import numpy as np
import raytracing as rt

#: The notebooks with less work, as the tests run them: pictures are smaller, samples fewer.
small = "RT_GUIDE_SMALL" in os.environ

#: Where scene files of the guide and the examples lie.
guide = pathlib.Path(__file__).resolve().parent
scenes = guide / "scenes"
examples = guide.parents[1] / "Assets" / "examples"

_COLORS = ("#1b6ca8", "#c8553d", "#3a7d44", "#8a5a9e", "#9a7b1c")
_WIDTH, _HEIGHT = 560, 340
_LEFT, _RIGHT, _TOP, _BOTTOM = 70, 16, 34, 46  # margins of a chart


class Figure:
    """What a cell shows: the bytes of a PNG file or the text of an SVG file."""

    def __init__(self, name: str, content: bytes) -> None:
        self.content = content
        self.is_svg = name.endswith(".svg")
        folder = os.environ.get("RT_GUIDE_PICTURES")
        if folder:
            (pathlib.Path(folder) / name).write_bytes(content)

    def _repr_png_(self) -> bytes | None:
        return None if self.is_svg else self.content

    def _repr_svg_(self) -> str | None:
        return self.content.decode() if self.is_svg else None


def picture(name: str, *images: np.ndarray, exposure: float = 0.0) -> Figure:
    """Linear pictures of one size beside each other; a map of one channel becomes grey."""
    rows = [np.repeat(image[..., None], 3, -1) if image.ndim == 2 else image for image in images]
    joined = np.ascontiguousarray(np.concatenate(rows, 1), np.float32)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "a.png"
        rt.write_image(file, rt.tonemap(joined, exposure=exposure, encode=False))
        return Figure(name + ".png", file.read_bytes())


def enlarged(image: np.ndarray, times: int = 4) -> np.ndarray:
    """The same with each pixel a square of so many, so that single pixels can be told."""
    return image.repeat(times, 0).repeat(times, 1)


def relmse(image: np.ndarray, reference: np.ndarray) -> float:
    """Mean over pixels and channels of (x - reference)^2 / (reference^2 + 0.01)."""
    return rt.metrics(np.ascontiguousarray(image), np.ascontiguousarray(reference))["relmse"]


def slope(x: Any, y: Any) -> float:
    """Of the straight line through the logarithms: y is about proportional to x to this power."""
    return float(np.polyfit(np.log(np.asarray(x, float)), np.log(np.asarray(y, float)), 1)[0])


class _Axis:
    def __init__(self, values: np.ndarray, is_log: bool, first: float, last: float) -> None:
        self.is_log, self.first, self.last = is_log, first, last
        scaled = self._scaled(values)
        self.low, self.high = float(scaled.min()), float(scaled.max())
        if self.low == self.high:
            self.high += 1.0

    def _scaled(self, values: Any) -> np.ndarray:
        return np.log10(values) if self.is_log else np.asarray(values, float)

    def place(self, values: Any) -> np.ndarray:
        return self.first + (self._scaled(values) - self.low) / (self.high - self.low) * (self.last - self.first)

    def ticks(self) -> list[float]:
        if self.is_log:
            decades = range(math.ceil(self.low), math.floor(self.high) + 1)
            if len(decades) >= 2:
                return [10.0**k for k in decades]
            return [float(f"{10**v:.1g}") for v in np.linspace(self.low, self.high, 4)]
        return [float(f"{v:.3g}") for v in np.linspace(self.low, self.high, 5)]


def chart(name: str, x_label: str, y_label: str, series: Mapping[str, tuple[Any, Any]], log: bool = True) -> Figure:
    """Lines of y over x, each with its name; log: both axes are logarithmic."""
    xs = np.concatenate([np.asarray(x, float) for x, _ in series.values()])
    ys = np.concatenate([np.asarray(y, float) for _, y in series.values()])
    across = _Axis(xs, log, _LEFT, _WIDTH - _RIGHT)
    up = _Axis(ys, log, _HEIGHT - _BOTTOM, _TOP + 18 * ((len(series) + 1) // 2))
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {_HEIGHT}" width="{_WIDTH}" '
             f'height="{_HEIGHT}" font-family="sans-serif" font-size="13">',
             f'<rect width="{_WIDTH}" height="{_HEIGHT}" fill="#fff"/>']

    def text(x: float, y: float, words: str, more: str = "") -> None:
        parts.append(f'<text x="{x:.1f}" y="{y:.1f}" fill="#222"{more}>{html.escape(words)}</text>')

    for tick in across.ticks():
        x = float(across.place(tick))
        parts.append(f'<path d="M{x:.1f} {_HEIGHT - _BOTTOM}V{_TOP}" stroke="#ddd"/>')
        text(x, _HEIGHT - _BOTTOM + 17, f"{tick:g}", ' text-anchor="middle"')
    for tick in up.ticks():
        y = float(up.place(tick))
        parts.append(f'<path d="M{_LEFT} {y:.1f}H{_WIDTH - _RIGHT}" stroke="#ddd"/>')
        text(_LEFT - 6, y + 4, f"{tick:g}", ' text-anchor="end"')
    text((_LEFT + _WIDTH) / 2, _HEIGHT - 8, x_label, ' text-anchor="middle"')
    text(_LEFT, 16, y_label)
    for i, (label, (x, y)) in enumerate(series.items()):
        color = _COLORS[i % len(_COLORS)]
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across.place(x), up.place(y)))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="2"/>')
        at = (_LEFT + 10 + 235 * (i % 2), _TOP + 18 * (i // 2))
        parts.append(f'<path d="M{at[0]} {at[1] - 4}h22" stroke="{color}" stroke-width="3"/>')
        text(at[0] + 28, at[1], label)
    return Figure(name + ".svg", "\n".join([*parts, "</svg>\n"]).encode())
