"""Faces of packages that import each of their names with its first use: who asks for one name loads its module only."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module


def lazy_face(package: str, homes: Mapping[str, str]) -> Callable[[str], object]:
    """Return the `__getattr__` of a package whose names come from the modules in `homes`.

    An `__init__.pyi` beside the `__init__.py` tells type checkers the same; `tests/house/test_python_face.py`
    compares them. No name may be that of a module in the package: that module would take its place once it is loaded.
    """

    def name_of(name: str) -> object:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        found: object = getattr(import_module(homes[name]), name)
        setattr(sys.modules[package], name, found)
        return found

    return name_of
