"""Finds states, worlds, drivers and servers by name, through the entry points of installed packages.

Groups: `flexcell.states` (a mapping of state name → class), `flexcell.worlds` and
`flexcell.drivers` (a maker per `kind`), `flexcell.servers`. A user's own state is also found as
`module:Class`. Nothing is imported before its name is asked for.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from importlib.metadata import EntryPoint, entry_points
from typing import Any, cast

from engine.errors import RegistryError
from engine.nearness import near_names
from engine.state import State

STATES = "flexcell.states"
WORLDS = "flexcell.worlds"
DRIVERS = "flexcell.drivers"
SERVERS = "flexcell.servers"


def load_states() -> dict[str, type[State]]:
    """Return every registered state by name.

    Raises:
        RegistryError: two packages offer the same name, or an entry point does not load.
    """
    catalogue: dict[str, type[State]] = {}
    for point in entry_points(group=STATES):
        offered = cast("Mapping[str, type[State]]", _loaded(point))
        for name, state in offered.items():
            if name in catalogue and catalogue[name] is not state:
                raise RegistryError(f"two packages offer the state {name}", where=point.value)
            catalogue[name] = state
    return dict(sorted(catalogue.items()))


def state_by_path(name: str) -> type[State]:
    """Return the state class named as `package.module:Class`.

    Raises:
        RegistryError: the module or class does not exist or is not a state.
    """
    module_name, _, class_name = name.partition(":")
    try:
        found = getattr(importlib.import_module(module_name), class_name)
    except (ImportError, AttributeError) as error:
        raise RegistryError(str(error), where=name, hint="write it as package.module:Class") from error
    except Exception as error:
        # Importing runs the module, which may raise anything; nobody but its author can mend that.
        message = f"importing {module_name!r} raised {type(error).__name__}: {error}"
        raise RegistryError(message, where=name, hint="write it as package.module:Class") from error
    if not (isinstance(found, type) and issubclass(found, State)):
        raise RegistryError("this is not a subclass of engine.state.State", where=name)
    return found


def load_maker(group: str, kind: str) -> Any:
    """Return what is registered as `kind` in `group`.

    Raises:
        RegistryError: nothing is; names near ones, or the extra that would bring it.
    """
    points = {point.name: point for point in entry_points(group=group)}
    if kind not in points:
        raise RegistryError(
            f"no {group.removeprefix('flexcell.')[:-1]} is named {kind!r}", hint=near_names(kind, points)
        )
    return _loaded(points[kind])


def _loaded(point: EntryPoint) -> Any:
    try:
        return point.load()
    except ImportError as error:
        raise RegistryError(
            f"{point.name} needs a package that is not installed: {error}",
            where=point.value,
            hint="pip install 'flexcell[all]'",
        ) from error
