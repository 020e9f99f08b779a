"""Scenes as the text of scene files."""

from __future__ import annotations

import json
import math
import os
from typing import Any, NoReturn

from . import _core

_MAX_DEPTH = 256  # as of scene files
_MAX_PLACE = 100  # letters of a place that are told


def _plain(value: Any) -> Any:
    """Arrays and numbers of numpy as lists and numbers."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a scene holds dicts, lists, texts and numbers, no {type(value).__name__}")


def to_json(value: Any, name: str = "scene") -> str:
    """Raises TypeError, or InputError, naming the place where a value is none of a scene's."""
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except (TypeError, ValueError, RecursionError):
        _find_fault(value, name, "", ())
        raise


def _find_fault(value: Any, name: str, place: str, holders: tuple[int, ...]) -> None:
    """holders: what holds the value, the outermost first."""

    def fail(kind: type[Exception], reason: str) -> NoReturn:
        told = place if len(place) <= _MAX_PLACE else place[:_MAX_PLACE] + "..."
        raise kind(f"{name}: {told + ': ' if told else ''}{reason}") from None

    if value is None or isinstance(value, (str, int)):
        return
    if isinstance(value, float):
        if not math.isfinite(value):
            fail(_core.InputError, f"must be a finite number; got {value}")
        return
    if id(value) in holders:
        fail(_core.InputError, "must not contain itself")
    if len(holders) > _MAX_DEPTH:
        fail(_core.InputError, f"values are nested deeper than {_MAX_DEPTH}")
    inside = (*holders, id(value))
    if isinstance(value, dict):
        for key, part in value.items():
            if not isinstance(key, (str, int, float, bool, type(None))):
                fail(TypeError, f"names are texts, no {type(key).__name__}")
            word = str(key).replace("~", "~0").replace("/", "~1")
            _find_fault(part, name, f"{place}/{word}", inside)
    elif isinstance(value, (list, tuple)):
        for i, part in enumerate(value):
            _find_fault(part, name, f"{place}/{i}", inside)
    else:
        try:
            plain = _plain(value)
        except TypeError as error:
            fail(TypeError, str(error))
        _find_fault(plain, name, place, inside)
