"""Converts `with:` of a document to constructor arguments of a py_trees behaviour, by its type hints."""

from __future__ import annotations

import inspect
import typing
from collections.abc import Collection, Mapping
from typing import Any

import msgspec
from py_trees.behaviour import Behaviour

from engine.errors import StateError
from engine.wording.misfit import explain_misfit
from engine.wording.suggestions import did_you_mean


def takes_name(kind: type[Behaviour]) -> bool:
    """Return whether the constructor has a parameter `name`, like those of py_trees."""
    return "name" in inspect.signature(kind).parameters


def wrong_arguments(kind: type[Behaviour], given: Collection[str]) -> tuple[str, str] | None:
    """Return the error and hint for wrong argument names, or None."""
    known = inspect.signature(kind).parameters
    if any(parameter.kind is parameter.VAR_KEYWORD for parameter in known.values()):
        return None
    for name in given:
        if name not in known:
            return f"{kind.__qualname__} takes no argument `{name}`", did_you_mean(name, known)
    for name, parameter in known.items():
        required = parameter.default is parameter.empty and parameter.kind is not parameter.VAR_POSITIONAL
        if required and name not in given and name != "name":
            return f"{kind.__qualname__} needs the argument `{name}`", f"add `{name}: …` to `with`"
    return None


def converted_arguments(kind: type[Behaviour], given: Mapping[str, Any], *, position: str) -> dict[str, Any]:
    """Return the arguments converted to the types of the constructor: `SUCCESS` becomes a status.

    Raises:
        StateError: a value does not fit its type.
    """
    try:
        hints = typing.get_type_hints(kind.__init__)
    except (AttributeError, NameError, TypeError):
        hints = {}
    arguments: dict[str, Any] = {}
    for name, value in given.items():
        declared = hints.get(name, Any)
        try:
            arguments[name] = msgspec.convert(value, declared)
        except msgspec.ValidationError as error:
            what = explain_misfit(error, declared)
            raise StateError(f"argument `{name}` of {kind.__qualname__}: {what}", where=position) from error
        except TypeError:
            # The type has no representation in documents; the constructor validates the value.
            arguments[name] = value
    return arguments
