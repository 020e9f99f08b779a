"""A bar that tells how far a render is, in a terminal or in a notebook."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._film import Film

_SECONDS = 0.2  # between two updates
_CELLS = 24


def _notebook() -> Any:
    """The display module of IPython in a notebook, else None."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    # That of ipykernel, from which notebooks of several makers derive their own.
    if not any(base.__name__ == "ZMQInteractiveShell" for base in type(shell).__mro__):
        return None
    from IPython import display

    return display


class Bar:
    """Shows nothing if `wanted` is False, or None where nobody looks."""

    def __init__(self, film: Film, wanted: bool | None, is_quiet: bool) -> None:
        self._film = film
        self._notebook = _notebook()
        has_terminal = sys.stderr is not None and sys.stderr.isatty()  # None: a program without a console
        looks = self._notebook is not None or has_terminal
        can_show = self._notebook is not None or sys.stderr is not None
        self._is_shown = looks and not is_quiet if wanted is None else bool(wanted) and can_show
        self._next = 0.0
        self._length = 0
        self._handle: Any = None

    def update(self) -> None:
        if self._is_shown and time.monotonic() >= self._next:
            self._next = time.monotonic() + _SECONDS
            self._show(self._film.progress_text)

    def finish(self) -> None:
        """The last line, which stays."""
        if not self._is_shown:
            return
        self._show(self._film.progress_text + ", " + ("done" if self._film.stopped_by == "spp" else
                                                      str(self._film.stopped_by).replace("_", " ")))
        if self._notebook is None:
            sys.stderr.write("\n")
            sys.stderr.flush()

    def _show(self, text: str) -> None:
        if self._notebook is not None:
            share = 100 * self._film.progress
            html = self._notebook.HTML(f'<progress value="{share:.1f}" max="100"></progress> <code>{text}</code>')
            if self._handle is None:
                self._handle = self._notebook.display(html, display_id=True)
            else:
                self._handle.update(html)
            return
        done = round(_CELLS * self._film.progress)
        line = f"[{'#' * done}{'.' * (_CELLS - done)}] {text}"
        sys.stderr.write("\r" + line.ljust(self._length))
        sys.stderr.flush()
        self._length = len(line)
