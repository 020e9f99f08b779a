"""The guide for students: its notebooks run, in small, and assert what the text claims; its commands run; its pages
name only labels that the windows have."""

import importlib.util
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

from support import PROGRAMS, SOURCE

GUIDE = SOURCE / "docs" / "guide"
PAGES = sorted(GUIDE.glob("0*.md"))
NOTEBOOKS = sorted(GUIDE.glob("*.ipynb"))
SMALLER = {"--width": 24, "--spp": 4}  # at most


def shell_lines(page):
    for block in re.findall(r"^```sh\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S):
        yield from (line for line in block.replace("\\\n", " ").splitlines() if line.strip())


def in_small(words):
    """The command with files of this tree by their full names, and less to render."""
    words = [str(SOURCE / word) if (SOURCE / word).exists() else word for word in words]
    for i, word in enumerate(words[:-1]):
        if word in SMALLER:
            words[i + 1] = str(min(int(words[i + 1]), SMALLER[word]))
    if words[0].startswith("ray-tracing-") and words[0] not in ("ray-tracing-image", "ray-tracing-bench"):
        words += ["--no-config", "--quiet"] + (["--width", "24"] if "--width" not in words else [])
    return [str(PROGRAMS.resolve() / words[0]), *words[1:]]


class Guide(unittest.TestCase):
    def test_there_is_a_notebook_for_each_chapter(self):
        self.assertEqual([page.stem for page in PAGES], [notebook.stem for notebook in NOTEBOOKS])
        self.assertEqual(len(PAGES), 9)

    def test_notebooks(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, str(GUIDE / "run.py"), "--small", "--output", folder],
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            made = set(os.listdir(folder))
        for page in PAGES:
            for name in re.findall(r"<!-- picture ([\w.-]+):", page.read_text(encoding="utf-8")):
                self.assertIn(name, made, page.name)

    def test_notebooks_hold_no_outputs(self):
        for notebook in NOTEBOOKS:
            data = json.loads(notebook.read_text(encoding="utf-8"))
            self.assertEqual((data["nbformat"], data["nbformat_minor"]), (4, 5))
            ids = [cell["id"] for cell in data["cells"]]
            self.assertEqual(len(ids), len(set(ids)))
            for cell in data["cells"]:
                if cell["cell_type"] == "code":
                    self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None))

    def test_a_claim_that_fails_is_a_failure(self):
        spec = importlib.util.spec_from_file_location("guide_run", GUIDE / "run.py")
        runner = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(runner)
        with tempfile.TemporaryDirectory() as folder:
            notebook = GUIDE.__class__(folder) / "a.ipynb"
            cells = [{"cell_type": "code", "source": ["x = 1\n", "y = 2"]}, {"cell_type": "markdown", "source": ["?"]},
                     {"cell_type": "code", "source": ["assert x > y"]}]
            notebook.write_text(json.dumps({"cells": cells}), encoding="utf-8")
            with self.assertRaises(AssertionError):
                runner.run(notebook)

    def test_commands(self):
        with tempfile.TemporaryDirectory() as folder:
            for page in (*PAGES, SOURCE / "docs" / "from-the-books.md"):
                lines = list(shell_lines(page))
                self.assertTrue(lines, f"{page.name} has no command")
                for line in lines:
                    with self.subTest(page=page.name, line=line):
                        done = subprocess.run(in_small(shlex.split(line)), cwd=folder, capture_output=True, text=True,
                                              check=False)
                        self.assertEqual(done.returncode, 0, done.stderr)

    def test_labels_are_those_of_the_windows(self):
        sources = [*(SOURCE / "Common" / "Gui").rglob("*.*"), SOURCE / "Common" / "Render" / "Names.h",
                   *(SOURCE / "Common" / "App" / "Interactive").glob("*.h")]
        texts = set()
        for source in sources:
            texts.update(re.findall(r'"((?:[^"\\\n]|\\.)*)"', source.read_text(encoding="utf-8")))
        for page in PAGES:
            text = page.read_text(encoding="utf-8")
            clicks = re.search(r"^## In the windows\n(.*?)^## ", text, re.M | re.S)
            self.assertTrue(clicks, page.name)
            labels = {" ".join(label.split()) for label in re.findall(r"\*\*([^*]+)\*\*", clicks[1])}
            self.assertGreaterEqual(len(labels), 3, page.name)
            self.assertEqual(labels - texts, set(), page.name)

    def test_pages_are_alike(self):
        for page in PAGES:
            text = page.read_text(encoding="utf-8")
            with self.subTest(page=page.name):
                for heading in ("What you will learn", "In the windows", "In the notebook", "Exercises", "Sources"):
                    self.assertEqual(text.count(f"\n## {heading}\n"), 1, heading)
                self.assertEqual(text.count("<details>"), 3)
                self.assertIn(f"({page.stem}.ipynb)", text)
                self.assertLessEqual(len(text.splitlines()), 150)
                scenes = re.findall(r"(?:docs/guide/scenes|Assets/examples)/[\w-]+\.json", text)
                self.assertTrue(scenes)
                for scene in scenes:
                    self.assertTrue((SOURCE / scene).is_file(), scene)


if __name__ == "__main__":
    unittest.main()
