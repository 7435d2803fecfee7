"""Takes values of the command line that are right as they are written; typer has pydantic convert all others.

Loading pydantic, which turns a text into that text, would be a quarter of what checking a small behavior takes.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Literal, cast, get_args, get_origin

_OTHER = object()
"""Stands for a value that typer converts, or refuses with its own words."""


def take_plain_values(command: Any) -> None:
    """Have the parameters of a command, and those that typer adds to it, look at a value before typer does."""
    get_params = command.get_params

    def get_plain_params(ctx: Any) -> list[Any]:
        parameters: list[Any] = get_params(ctx)
        for each in parameters:
            # typer has it from 0.29 on, and knew no pydantic before.
            if hasattr(each, "type_descriptor") and each._runtime_param is None:
                each._runtime_param = _PlainValues(each.type_descriptor)
        return parameters

    command.get_params = get_plain_params


class _PlainValues:
    """Stands before the conversion of one parameter."""

    def __init__(self, wanted: Any) -> None:
        self._kind: Any = wanted.annotation
        self._options: Any = wanted.parameter_info

    def coerce(self, value: Any, param: Any, ctx: Any) -> object:
        """Return the value that the command is called with; raises what typer does."""
        if value is None:
            return () if param.multiple or param.nargs == -1 else None
        plain = _plain(value, self._kind, self._options)
        if plain is _OTHER:
            param._runtime_param = None
            return param.get_runtime_param().coerce(value, param=param, ctx=ctx)
        return plain


def _plain(value: Any, kind: Any, options: Any) -> object:
    """Return what typer makes of a value where that is easy to tell."""
    if options.parser is not None:
        return _OTHER
    if get_origin(kind) is list:
        return _plain_list(value, get_args(kind)[0], options)
    if get_origin(kind) is Literal:
        return value if value in get_args(kind) else _OTHER
    if kind is Path:
        return Path(value) if _is_plain_path(value, options) else _OTHER
    if kind is str:
        return value if isinstance(value, str) else _OTHER
    return value if type(value) is kind and _is_in_range(value, options) else _OTHER


def _plain_list(values: Any, kind: Any, options: Any) -> object:
    if not isinstance(values, (list, tuple)):
        return _OTHER
    found = [_plain(each, kind, options) for each in cast("Iterable[Any]", values)]
    return _OTHER if any(each is _OTHER for each in found) else found


def _is_in_range(value: Any, options: Any) -> bool:
    return (options.min is None or value >= options.min) and (options.max is None or value <= options.max)


def _is_plain_path(value: Any, options: Any) -> bool:
    """Tell whether nothing is asked of a path but that it can be read where it exists."""
    asked = (options.exists, options.writable, options.resolve_path, options.allow_dash, options.path_type)
    usual = not any(asked) and options.file_okay and options.dir_okay
    return usual and isinstance(value, (str, Path)) and (not os.path.exists(value) or os.access(value, os.R_OK))
