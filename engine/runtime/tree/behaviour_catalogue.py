"""Catalogue of the py_trees behaviours that documents may name: those of py_trees and of the project's modules.

Separate from `engine.document.state_catalogue`, as most documents name none and py_trees is slow to import.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from types import ModuleType

import py_trees.behaviours
import py_trees.timers
from py_trees.behaviour import Behaviour

from engine.document.state_catalogue import NO_CLASSES, Catalogue, module_of
from engine.errors import RegistryError
from engine.wording.suggestions import did_you_mean

_PY_TREES: Mapping[str, ModuleType] = {module.__name__: module for module in (py_trees.behaviours, py_trees.timers)}
"""Modules of py_trees, whose behaviours every document may name."""


def find_behaviour(catalogue: Catalogue, name: str, given: Mapping[str, type] = NO_CLASSES) -> type[Behaviour]:
    """Return the py_trees behaviour that a document names; arguments and errors as in `find_state`."""
    module_name, _, class_name = name.partition(":")
    kind: object = given.get(name)
    if kind is None:
        module = _PY_TREES.get(module_name) or module_of(catalogue, module_name)
        if class_name not in vars(module):
            known = [each for each, value in vars(module).items() if _is_behaviour(value)]
            raise RegistryError(f"`{module_name}` has no `{class_name}`", hint=did_you_mean(class_name, known))
        kind = vars(module)[class_name]
    if not (isinstance(kind, type) and issubclass(kind, Behaviour)) or inspect.isabstract(kind):
        raise RegistryError(
            f"`{name}` is not a concrete py_trees behaviour",
            hint="it must be a subclass of py_trees.behaviour.Behaviour with an `update`",
        )
    return kind


def _is_behaviour(value: object) -> bool:
    return isinstance(value, type) and issubclass(value, Behaviour) and not inspect.isabstract(value)
