"""Substitutes as tests write them: a mapping of path patterns to outcomes, endings, scripts or state classes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from engine.document import Behavior
from engine.document.substitutes import Substitute, SubstituteEnding, load_substitutes, new_substitutes
from engine.state import State

StandInFor = str | SubstituteEnding | Sequence[str | SubstituteEnding] | type[State]
"""An outcome, an ending, a list of these for successive activations, or a class that is executed instead."""


def with_substitutes(behavior: Behavior, substitutes: Path | str | Mapping[str, StandInFor]) -> Behavior:
    """Return a behavior with substitutes: those of a substitutes document, or of a test by path pattern.

    Raises:
        DocumentError: the document cannot be read or is not valid.
    """
    if not isinstance(substitutes, Mapping):
        return behavior.with_substitutes(load_substitutes(substitutes))
    classes = {_name(each): each for each in substitutes.values() if isinstance(each, type)}
    made = new_substitutes([_entry(at, each) for at, each in substitutes.items()])
    return behavior.with_substitutes(replace(made, classes=classes))


def _entry(at: str, given: StandInFor) -> Substitute:
    if isinstance(given, type):
        return Substitute(at=at, state=_name(given))
    if isinstance(given, str | SubstituteEnding):
        return Substitute(at=at, script=(_ending(given),))
    return Substitute(at=at, script=tuple(map(_ending, given)))


def _ending(given: str | SubstituteEnding) -> SubstituteEnding:
    return SubstituteEnding(outcome=given) if isinstance(given, str) else given


def _name(state: type) -> str:
    return f"{state.__module__}:{state.__qualname__}"
