#!/usr/bin/env python3
"""What tests/peers/compare.sh found, as a table and, of the first file, as a figure.
    tests/peers/figure.py FIGURE.svg CARD.csv RESULTS.csv...
Seconds are processor seconds over the number of threads: of our rows wall time and its share that was had, of imported
ones as they were measured. So they are those of an idle machine, up to what programs take from each other's caches.
The figure also has CARD.csv, a report of the benchmark of the same picture on a graphics card, whose seconds are wall
time.
"""
import csv
import math
import sys
from html import escape

NAMES = {"multi": "CPU, raw", "ours, denoised": "CPU, denoised", "Cycles": "Cycles"}
CARD = {"off": "GPU, raw", "on": "GPU, denoised"}
COLORS = {"CPU, raw": "#0072b2", "CPU, denoised": "#009e73", "Cycles": "#d55e00", "GPU, raw": "#cc79a7",
          "GPU, denoised": "#7a5195"}
PLACES = {"CPU, denoised": (0, 20, "middle"), "GPU, denoised": (0, 20, "middle")}  # of names, from the last point
LEFT, RIGHT, TOP, BOTTOM, WIDTH, HEIGHT = 64, 150, 34, 46, 640, 340


def rows_of(path):
    with open(path, encoding="utf-8") as file:
        yield from csv.DictReader(file)


def sorted_curves(named_points):
    found = {}
    for name, seconds, error in named_points:
        found.setdefault(name, []).append((seconds, error))
    return {name: sorted(points) for name, points in found.items()}


def curves(path):
    """Points (seconds, relMSE) by program, as far as their seconds are known."""
    def points():
        for row in rows_of(path):
            own = row["engine"] == "multi"
            if row["engine"] in NAMES and (not own or row["threads_busy"]):
                seconds = float(row["seconds"]) * (float(row["threads_busy"]) if own else 1)
                yield NAMES[row["engine"]], seconds, float(row["relmse"])
    return sorted_curves(points())


def card_curves(path):
    return sorted_curves((CARD[row["denoise"]], float(row["seconds"]), float(row["relmse"])) for row in rows_of(path))


def seconds_to(points, error):
    """On straight lines between logarithms; None where no measurement lies on both sides."""
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e1 <= error <= e0:
            share = math.log(error / e0) / math.log(e1 / e0) if e1 != e0 else 0
            return t0 * (t1 / t0) ** share
    return None


def table(path):
    found = curves(path)
    error = max(min(e for _, e in points) for points in found.values())  # all reach it
    cycles = seconds_to(found["Cycles"], error)
    lines = [f"{path}: seconds to relMSE {error:.3g}"]
    for name in NAMES.values():
        seconds = seconds_to(found[name], error)
        if seconds:
            ratio = f", {cycles / seconds:.3g} times as quick as Cycles" if name != "Cycles" and cycles else ""
            lines.append(f"  {name}: {seconds:.3g} s{ratio}")
    return "\n".join(lines)


class Axis:
    """Powers of ten."""

    def __init__(self, values, begin, end):
        self.low = math.floor(math.log10(min(values)) * 2) / 2
        self.high = math.ceil(math.log10(max(values)) * 2) / 2
        self.begin, self.end = begin, end

    def __call__(self, value):
        return self.begin + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.begin)

    def ticks(self):
        return [10.0**e for e in range(math.ceil(self.low), math.floor(self.high) + 1)]


def figure(found, title):
    x = Axis([t for points in found.values() for t, _ in points], LEFT, WIDTH - RIGHT)
    y = Axis([e for points in found.values() for _, e in points], HEIGHT - BOTTOM, TOP)
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" '
             f'viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
             'font-family="sans-serif" font-size="13" role="img">',
             f"<title>{escape(title)}</title>", '<rect width="100%" height="100%" fill="#fff"/>']

    def line(x0, y0, x1, y1, color):
        parts.append(f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}" stroke="{color}"/>')

    def text(at_x, at_y, content, anchor="middle", color="#222"):
        place = f'x="{at_x:.1f}" y="{at_y:.1f}" text-anchor="{anchor}"'
        parts.append(f'<text {place} fill="{color}">{escape(content)}</text>')

    for tick in x.ticks():
        line(x(tick), y.begin, x(tick), y.end, "#ddd")
        text(x(tick), y.begin + 18, f"{tick:g}")
    for tick in y.ticks():
        line(x.begin, y(tick), x.end, y(tick), "#ddd")
        text(x.begin - 8, y(tick) + 4, f"{tick:g}", "end")
    line(x.begin, y.begin, x.end, y.begin, "#888")
    line(x.begin, y.begin, x.begin, y.end, "#888")
    text((x.begin + x.end) / 2, HEIGHT - 8, "seconds, of the CPU on two threads")
    text(x.begin, 20, "error (relMSE)", "middle")
    for name, measured in found.items():
        points = [(x(t), y(e)) for t, e in measured]
        way = " ".join(f"{px:.1f},{py:.1f}" for px, py in points)
        parts.append(f'<polyline points="{way}" fill="none" stroke="{COLORS[name]}" stroke-width="2"/>')
        parts += [f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3.5" fill="{COLORS[name]}"/>' for px, py in points]
        dx, dy, anchor = PLACES.get(name, (10, 4, "start"))
        text(points[-1][0] + dx, points[-1][1] + dy, name, anchor, COLORS[name])
    return "\n".join(parts) + "\n</svg>\n"


def main(output, card, files):
    for path in files:
        print(table(path))
    found = {**curves(files[0]), **card_curves(card)}
    with open(output, "w", encoding="utf-8") as file:
        file.write(figure(found, "Error of the picture against seconds: ours on CPU and GPU, raw and denoised, and Cycles"))


main(sys.argv[1], sys.argv[2], sys.argv[3:])
