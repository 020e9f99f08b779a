"""Keywords of render() and its kin as flags of the programs: the programs' own parser reads them."""

from __future__ import annotations

import functools
import os
from typing import Any

from . import _core
from ._arguments import is_plain
from ._json import to_json

CPU = "ray-tracing-cpu"
GPU = "ray-tracing-gpu"


class _Flag:
    """What a flag takes, as the parser says it."""

    def __init__(self, value: str, is_repeatable: bool) -> None:
        self.is_switch = value == ""
        self.is_repeatable = is_repeatable
        self.words = value.split("|")


@functools.lru_cache(maxsize=None)
def _table(program: str) -> dict[str, _Flag]:
    return {name: _Flag(value, is_repeatable)
            for names, value, _, is_repeatable in _core.flags(program) for name in names}


def _text(value: Any) -> str:
    if isinstance(value, (bool,)):
        return "on" if value else "off"
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, (list, tuple)):
        return ",".join(_text(part) for part in value)
    if hasattr(value, "item") and getattr(value, "ndim", 1) == 0:  # a number of numpy
        return _text(value.item())
    return str(value)


def _said(name: str, value: Any) -> str:
    text = f"{name}={to_json(value, name) if isinstance(value, dict) else _text(value)}"
    if not is_plain(text):
        raise _core.UsageError(f"{name} {value!a}: must be a text of UTF-8 without NUL")
    return text


def arguments(program: str, keywords: dict[str, Any]) -> list[str]:
    """spp=16, adaptive=True, output=["a.png"] -> ["--spp=16", "--adaptive=on", "--output=a.png"]. None says nothing."""
    result = []
    for key, value in keywords.items():
        name = "--" + key.replace("_", "-")
        flag = _table(program).get(name)
        if value is None or (flag is not None and flag.is_switch and value is False):
            continue
        if flag is not None and flag.is_switch:
            if value is not True:
                raise _core.UsageError(f"{name} {value}: must be True or False")
            result.append(name)
        elif flag is not None and flag.is_repeatable and isinstance(value, (list, tuple)):
            result += [_said(name, part) for part in value]
        else:
            result.append(_said(name, value))
    if "config" not in keywords and "no_config" not in keywords:
        result.append("--no-config")  # a script renders the same on every machine
    return result


@functools.lru_cache(maxsize=None)
def _has_hardware() -> bool:
    return _core.has_gpu and _core.has_hardware_device()


def choose(engine: str, keywords: dict[str, Any]) -> tuple[str, dict[str, Any]]:
    """The program whose flags are meant, and the keywords with its own --engine."""
    if engine == "auto":
        names = {"--" + key.replace("_", "-") for key in keywords}
        only_gpu = names & (_table(GPU).keys() - _table(CPU).keys())
        only_cpu = names & (_table(CPU).keys() - _table(GPU).keys())
        return (GPU if only_gpu or (_has_hardware() and not only_cpu) else CPU), keywords
    if engine in ("cpu", "gpu"):
        return (GPU if engine == "gpu" else CPU), keywords
    words = ["auto", "cpu", "gpu"]
    for program in (CPU, GPU):
        own = [word for word in _table(program)["--engine"].words if word != "auto"]
        if engine in own:
            return program, {**keywords, "engine": engine}
        words += own
    raise _core.UsageError(f"engine {engine}: must be {', '.join(words[:-1])} or {words[-1]}")


def options(engine: str, keywords: dict[str, Any]) -> _core.Options:
    program, chosen = choose(engine, keywords)
    return _core.parse_flags(program, arguments(program, chosen))


def flags(engine: str = "cpu") -> str:
    """Every keyword that render() takes, with what it means: the flags of ray-tracing-cpu or, for "gpu", of
    ray-tracing-gpu. Their dashes are underscores in keywords; True and False stand for on and off."""
    lines = []
    for names, value, text, _ in _core.flags(GPU if engine == "gpu" else CPU):
        long = next((name for name in names if name.startswith("--")), None)
        if long is not None:
            lines += [f"{long[2:].replace('-', '_')} = {value or 'True | False'}", "    " + text]
    return "\n".join(lines)
