#!/usr/bin/env python3
"""Runs the guide's notebooks, the cells of each in order, without Jupyter; what they claim is asserted in them.

    docs/guide/run.py [--small] [--output FOLDER] [NN...]

--small: with less work. --output: pictures go there. NN: only chapters whose names begin so, such as 03.
It needs numpy and the module raytracing (./build.sh python).
"""

from __future__ import annotations

import argparse
import json
import os
import pathlib
import sys
import time

FOLDER = pathlib.Path(__file__).resolve().parent


def code_cells(notebook: pathlib.Path) -> list[str]:
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]


def run(notebook: pathlib.Path) -> None:
    """Raises what a cell raises; the traceback names notebook and cell."""
    names: dict[str, object] = {"__name__": "__main__"}
    for number, cell in enumerate(code_cells(notebook), 1):
        exec(compile(cell, f"{notebook.name}, cell {number}", "exec"), names)


def main() -> None:
    parser = argparse.ArgumentParser(description="Runs the notebooks of the guide.")
    parser.add_argument("--small", action="store_true", help="with less work")
    parser.add_argument("--output", metavar="FOLDER", help="where pictures go")
    parser.add_argument("chapters", nargs="*", metavar="NN", help="only chapters whose names begin so")
    arguments = parser.parse_args()
    if arguments.small:
        os.environ["RT_GUIDE_SMALL"] = "1"
    if arguments.output:
        os.makedirs(arguments.output, exist_ok=True)
        os.environ["RT_GUIDE_PICTURES"] = os.path.abspath(arguments.output)
    sys.path.insert(0, str(FOLDER))
    notebooks = [n for n in sorted(FOLDER.glob("*.ipynb"))
                 if not arguments.chapters or n.name.startswith(tuple(arguments.chapters))]
    if not notebooks:
        parser.error("no chapter is named so")
    for notebook in notebooks:
        begin = time.process_time()
        run(notebook)
        print(f"{notebook.name}: {time.process_time() - begin:.1f} s of processor time", flush=True)


if __name__ == "__main__":
    main()
