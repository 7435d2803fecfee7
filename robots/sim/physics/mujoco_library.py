"""Loads MuJoCo without the window library that it imports for its own viewer.

`glfw` starts a Python process to determine the version of its shared library, a fifth of MuJoCo's
load time. It is loaded on first use, by `mujoco.Renderer` or `mujoco.viewer`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import LazyLoader
from types import ModuleType
from typing import Any

_WINDOWS = "glfw"


class _WindowsOnDemand(MetaPathFinder):
    """Finds the window library where Python does, with a loader that defers loading to its first use."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        spec = PathFinder.find_spec(fullname, path, target) if fullname == _WINDOWS else None
        if spec is not None and spec.loader is not None:
            spec.loader = LazyLoader(spec.loader)
        return spec


def load_mujoco() -> Any:
    """Return the module `mujoco`; its Python bindings carry no types."""
    importer = _WindowsOnDemand()
    sys.meta_path.insert(0, importer)
    try:
        return import_module("mujoco")
    finally:
        sys.meta_path.remove(importer)
