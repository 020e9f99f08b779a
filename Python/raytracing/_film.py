"""Renders."""

from __future__ import annotations

import atexit
import collections.abc
import json
import os
from typing import Any, Iterator

import numpy as np

from . import _arguments, _core, _flags
from ._progress import Bar
from ._scene import Scene, Source

_SLICE = 0.2  # seconds between two looks at Ctrl-C and whoever calls the render off


# Renders of daemon threads end with the interpreter, their files written, as by Ctrl-C. Windows has no fork.
atexit.register(_core.end_activities)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_core.forget_activities)


def _check_cancel(cancel: Any) -> None:
    if cancel is not None and not callable(getattr(cancel, "is_set", None)):
        raise TypeError(f"cancel: expected an object with is_set(), as threading.Event; got {type(cancel).__name__}")


class Aovs(collections.abc.Mapping):
    """Images beside the picture, made when they are asked for: film.aov["normal"] is float32 (height, width, 3). Names
    are those of --aov. Features of surfaces are averages over 16 samples of a pixel, or fewer if it has fewer."""

    def __init__(self, film: Film) -> None:
        self._film = film

    def __getitem__(self, name: str) -> np.ndarray:
        _arguments.text("aov", name)
        return self._film._picture(name, lambda: self._film._core.aov(name))

    def __contains__(self, name: object) -> bool:
        return name in _core.aov_names

    def __iter__(self) -> Iterator[str]:
        return iter(_core.aov_names)

    def __len__(self) -> int:
        return len(_core.aov_names)


class Film:
    """A render: its picture so far, and how it goes on. Threads may share one; cancel() ends a render in another one.

    Film(scene, engine, **flags) begins a render without a sample; run() and advance() add them. render() does both.
    """

    def __init__(self, scene: Source, engine: str = "auto", **flags: Any) -> None:
        options = _flags.options(engine, flags)
        self.scene = scene if isinstance(scene, Scene) else Scene(scene)
        self._core = _core.Film(self.scene._compile(options), options)
        self._is_quiet: bool = options.quiet
        self._pictures: dict[str, np.ndarray] = {}
        self._is_written = False
        #: What has ended the render: "spp", "time_limit", "target_error", "interrupted", "failure"; None: it can go on.
        self.stopped_by: str | None = None

    def __repr__(self) -> str:
        return f"<raytracing.Film {self.width}x{self.height}, {self.progress_text}>"

    # ---- going on ----

    def advance(self, seconds: float = _SLICE) -> bool:
        """Samples for about so many seconds. False: the render has ended, see stopped_by. KeyboardInterrupt leaves the
        film as it is; a failure of the device raises RenderError."""
        seconds = _arguments.number("seconds", seconds)
        self._pictures = {}
        while self.stopped_by is None:
            self.stopped_by = self._core.advance(min(seconds, _SLICE))
            seconds -= _SLICE
            if seconds <= 0:
                break
        return self.stopped_by is None

    def cancel(self) -> None:
        """Ends the render, which another thread may drive, within 100 ms: stopped_by is "interrupted" then."""
        self._core.cancel()

    def run(self, progress: bool | None = None, cancel: Any = None) -> Film:
        """To the end of the render; then files that the flags name are written. progress: whether a bar shows it; None:
        in a terminal and in a notebook. cancel: an object whose is_set() tells, as threading.Event's does, that the
        render is to end. Ctrl-C writes the files of what there is and raises KeyboardInterrupt."""
        _check_cancel(cancel)
        with _core.Activity():
            return self._run(Bar(self, progress, self._is_quiet), cancel)

    def _run(self, bar: Bar, cancel: Any) -> Film:
        try:
            while self.advance():
                bar.update()
                if cancel is not None and cancel.is_set():
                    self.cancel()
        except KeyboardInterrupt:
            self.interrupt()
            bar.finish()
            raise
        except (_core.RenderError, MemoryError):  # what there is of it is written, as the programs do
            self.stopped_by = "failure"
            bar.finish()
            self.write()
            raise
        bar.finish()
        self.write()
        return self

    def interrupt(self) -> None:
        """cancel(), for the thread that drives the render: the render has ended when this returns, and its files are
        written."""
        self._core.cancel()
        self.advance(0)
        self.write()

    def write(self) -> None:
        """Files that the flags name, such as output and stats, once. Raises RenderError naming the first that cannot be
        written."""
        if not self._is_written:
            self._is_written = True
            self._core.write()

    # ---- what there is ----

    @property
    def width(self) -> int:
        """Pixels."""
        return self._core.width

    @property
    def height(self) -> int:
        return self._core.height

    @property
    def image(self) -> np.ndarray:
        """float32 (height, width, 3), rows from the top: linear radiance with Rec. 709 primaries, each pixel the mean
        of its samples so far. The array owns what the film resolved; nothing is copied."""
        return self._picture("", self._core.image)

    @property
    def aov(self) -> Aovs:
        return Aovs(self)

    @property
    def denoised(self) -> np.ndarray:
        """The picture with less noise, float32 (height, width, 3). It needs two halves of the samples: denoise=True, or
        replicates=2 or more; otherwise InputError says so."""
        return self.aov["denoised"]

    @property
    def stats(self) -> dict[str, Any]:
        """What the statistics file holds, of the film as it is: seconds, rays, samples, error estimates, the kernel."""
        return json.loads(self._core.statistics())

    def checkpoint(self, file: str | os.PathLike[str] | None = None) -> str:
        """Writes a checkpoint, from which render(..., resume=file) goes on as if it had never stopped, bit for bit.
        Without a file it is the one that the flag checkpoint named. Returns its name."""
        name = self._core.checkpoint_file if file is None else _arguments.file("file", file)
        if not name:
            raise _core.UsageError("--checkpoint: checkpoint() needs a file, or this flag")
        self._core.save(name)
        return name

    @property
    def progress(self) -> float:
        """Share of the samples that are done, 0 to 1."""
        done, total, *_ = self._core.progress()
        return done / total if total else 1.0

    @property
    def progress_text(self) -> str:
        """Samples per pixel, percent, speed and time left, as the programs say it."""
        return self._core.progress()[4]

    def _picture(self, name: str, make: Any) -> np.ndarray:
        if name not in self._pictures:
            self._pictures[name] = make()
        return self._pictures[name]


def render(scene: Source, engine: str = "auto", *, progress: bool | None = None, cancel: Any = None,
           **flags: Any) -> Film:
    """Renders a scene: what load() takes, or has given.

    engine: "cpu", "gpu", or "auto": the GPU where there is one that is no program of the processor; or an engine of
    either program by its name. Every flag of the programs is a keyword, with underscores for dashes and True or False
    for on or off: spp=16, width=300, light_sampling="bsdf", denoise=True, output="a.png". print(raytracing.flags())
    lists them, docs/reference.md explains them. The same flags give the bits of the programs.

    progress, cancel: as Film.run() takes them. Errors are UsageError, InputError, RenderError and NoDeviceError with
    the texts of the programs.
    """
    _check_cancel(cancel)
    return Film(scene, engine, **flags).run(progress, cancel)


class Progressive:
    """See progressive()."""

    def __init__(self, film: Film, every: float, progress: bool | None) -> None:
        #: The render itself, also when the loop has ended.
        self.film = film
        self._every = every
        self._bar = Bar(film, progress, film._is_quiet)

    def __iter__(self) -> Progressive:
        return self

    def __next__(self) -> Film:
        film = self.film
        if film.stopped_by is not None:
            raise StopIteration
        with _core.Activity():
            try:
                film.advance(self._every)
            except KeyboardInterrupt:
                film.interrupt()
            if film.stopped_by is None:
                self._bar.update()
            else:
                self._bar.finish()
                film.write()
        return film


def progressive(scene: Source, engine: str = "auto", *, every: float = 0.5, progress: bool | None = None,
                **flags: Any) -> Progressive:
    """Renders step by step: for film in progressive("cornell-box", spp=1000): show(film.image).

    Each step takes about `every` seconds and yields the film; the last one has stopped_by set. Ctrl-C during a step
    ends the loop with what there is: the film stays usable. The rest is as of render().
    """
    every = _arguments.number("every", every)
    if not every > 0:
        raise ValueError(f"every: expected a number of seconds above 0; got {every}")
    return Progressive(Film(scene, engine, **flags), every, progress)
