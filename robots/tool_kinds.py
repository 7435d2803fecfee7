"""The table of the kinds of tools: the only place that names all of them.

A kind is loaded by its place, so that its folder may use all rooms of robots, and the rooms none of its names. Its
mechanisms and its simulation are loaded by place too: whoever asks for its states loads neither.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import cast

from engine.cell import ToolKind
from engine.errors import CellError
from engine.wording import did_you_mean

TOOL_KINDS: dict[str, str] = {
    "gripper": "robots.standard_tools.gripper_kind:GRIPPER",
    "hand": "robots.standard_tools.hand_kind:HAND",
    "magnet": "robots.magnet.magnet_kind:MAGNET",
}
"""Kind of tool → `module:NAME` of its `ToolKind`."""


def tool_kinds() -> Mapping[str, ToolKind]:
    """Return all kinds of tools by name."""
    return {name: tool_kind(name) for name in TOOL_KINDS}


def tool_kind(name: str) -> ToolKind:
    """Return a kind of tool; raises CellError with similar names where there is none."""
    if name not in TOOL_KINDS:
        raise CellError(f"there is no kind of tool {name}", where=name, hint=did_you_mean(name, TOOL_KINDS))
    return cast("ToolKind", _found_at(TOOL_KINDS[name]))


def kind_of_mechanism(tag: str) -> ToolKind:
    """Return the kind of the tools with a mechanism; raises CellError where there is none."""
    for kind in tool_kinds().values():
        if tag in kind.mechanisms:
            return kind
    raise CellError(f"no kind of tool has the mechanism {tag}", where=tag)


def load_simulation(name: str) -> object:
    """Return what simulates a kind of tool; each room of the simulator knows the part of it that it asks."""
    return _found_at(tool_kind(name).simulation)


def load_switched(name: str) -> object:
    """Return what serves a tool of a kind on digital outputs; raises CellError for a kind without."""
    kind = tool_kind(name)
    if not kind.switched:
        raise CellError(f"a tool of the kind {name} cannot be switched by outputs", where=name)
    return _found_at(kind.switched)


def load_mechanisms() -> tuple[object, ...]:
    """Return the models of the mechanisms of all kinds."""
    return tuple(_found_at(place) for kind in tool_kinds().values() for place in kind.mechanisms.values())


def _found_at(place: str) -> object:
    module, _, name = place.partition(":")
    return getattr(importlib.import_module(module), name)
