"""The public classes of a package and the names of their fields, to compare classes by what they say."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from types import ModuleType
from typing import Any

import msgspec
from pydantic import BaseModel


@cache
def public_classes(package: str) -> dict[str, type[Any]]:
    """Return the public classes with fields that a package defines, by their full names."""
    return {
        f"{cls.__module__}.{cls.__qualname__}": cls
        for module in _modules(importlib.import_module(package))
        for _, cls in inspect.getmembers(module, inspect.isclass)
        if cls.__module__ == module.__name__ and not cls.__name__.startswith("_") and field_names(cls)
    }


def field_names(cls: type[Any]) -> frozenset[str]:
    """Return the names of the fields of a struct, dataclass, body or protocol, with those of its bases."""
    if issubclass(cls, msgspec.Struct):
        return frozenset(cls.__struct_fields__)
    if is_dataclass(cls):
        return frozenset(each.name for each in fields(cls))
    if issubclass(cls, BaseModel):
        return frozenset(cls.model_fields)
    if getattr(cls, "_is_protocol", False):
        return frozenset(_protocol_fields(cls))
    return frozenset()


def own_fields(cls: type[Any], *, packages: tuple[str, ...], apart_from: tuple[type[Any], ...] = ()) -> frozenset[str]:
    """Return the fields of a class that it inherits neither from a class of these packages nor from one of these."""
    inherited = [
        field_names(base)
        for base in cls.__mro__[1:]
        if base in apart_from or base.__module__.partition(".")[0] in packages
    ]
    return field_names(cls).difference(*inherited)


def _protocol_fields(cls: type[Any]) -> Iterator[str]:
    for base in cls.__mro__:
        if getattr(base, "_is_protocol", False):
            yield from (each for each in inspect.get_annotations(base) if not each.startswith("_"))
            yield from (name for name, each in vars(base).items() if isinstance(each, property))


def _modules(package: ModuleType) -> Iterator[ModuleType]:
    for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        yield importlib.import_module(found.name)
