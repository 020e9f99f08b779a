"""Arguments that are not as described: one line that names the argument, what is expected and what it got."""

from __future__ import annotations

import numbers
import operator
import os
from typing import Any


def is_plain(text: str) -> bool:
    """Whether C++ gets all of a text: UTF-8 can say it, and no NUL ends it."""
    return "\0" not in text and not any("\ud800" <= letter <= "\udfff" for letter in text)


def text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name}: expected a text; got {type(value).__name__}")
    if not is_plain(value):
        raise ValueError(f"{name}: expected a text of UTF-8 without NUL; got {value!a}")
    return value


def file(name: str, value: Any) -> str:
    try:
        decoded = os.fsdecode(value)
    except TypeError:
        raise TypeError(f"{name}: expected the name of a file; got {type(value).__name__}") from None
    return text(name, decoded)


def number(name: str, value: Any) -> float:
    if not isinstance(value, numbers.Real):
        raise TypeError(f"{name}: expected a number; got {type(value).__name__}")
    try:
        result = float(value)
    except OverflowError:
        result = float("inf") if value > 0 else float("-inf")
    if result != result:
        raise ValueError(f"{name}: expected a number; got nan")
    return result


def whole(name: str, value: Any, first: int, last: int) -> int:
    try:
        result = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: expected a whole number; got {type(value).__name__}") from None
    if not first <= result <= last:
        raise ValueError(f"{name}: expected a whole number from {first} to {last}; got {result}")
    return result


def instance(name: str, value: Any, kind: Any, expected: str) -> Any:
    if not isinstance(value, kind):
        raise TypeError(f"{name}: expected {expected}; got {type(value).__name__}")
    return value
