"""Signatures of states: what is read from a class, and which classes are refused."""

from __future__ import annotations

from typing import ClassVar

import pytest

from engine.document import read_signature
from engine.errors import StateError
from engine.state import Context, Outcome, State
from tests.engine.check.example_states import Look, Move, Pick


def test_a_signature_says_what_the_class_declares() -> None:
    """Name, documentation, outcomes, and parameters with schema and default."""
    signature = read_signature(Move)
    assert (signature.name, signature.summary, signature.outcomes) == (
        "arm.Move",
        "Move an arm.",
        ("reached", "failed"),
    )
    assert {name: (p.required, p.default) for name, p in signature.parameters.items()} == {
        "robot": (True, None),
        "speed": (False, 0.5),
        "target": (False, None),
        "pose": (False, None),
    }
    assert signature.parameters["speed"].schema == {
        "type": "number",
        "exclusiveMinimum": 0.0,
        "maximum": 1.0,
        "description": "Share of the limits",
    }


def test_inputs_and_outputs_have_types_and_defaults() -> None:
    """Inputs are the keyword-only arguments of `run`."""
    inputs = read_signature(Pick).inputs
    assert {name: (key.type, key.required, key.default) for name, key in inputs.items()} == {
        "part": (str, True, None),
        "tries": (int, False, 3),
    }
    assert {name: key.schema for name, key in read_signature(Look).outputs.items()} == {"part": {"type": "string"}}


class Silent(State, frozen=True, kw_only=True):
    """Declares no outcome."""

    async def run(self, ctx: Context) -> Outcome:
        """End."""
        return Outcome("done")


class Blocking(State, frozen=True, kw_only=True):
    """Does not await."""

    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    def run(self, ctx: Context) -> Outcome:  # pyright: ignore[reportIncompatibleMethodOverride] - the mistake under test
        """End."""
        return Outcome("done")


class Inert(State, frozen=True, kw_only=True):
    """Has nothing to run."""

    outcomes: ClassVar[tuple[str, ...]] = ("done",)


class Positional(State, frozen=True, kw_only=True):
    """Takes an input by position."""

    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context, part: str = "") -> Outcome:
        """End."""
        return Outcome("done")


class Untyped(State, frozen=True, kw_only=True):
    """Takes an input without a type."""

    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context, *, part=None) -> Outcome:  # noqa: ANN001 # pyright: ignore - the mistake under test
        """End."""
        return Outcome("done")


class Dangling(State, frozen=True, kw_only=True):
    """Calls an outcome success that it does not have."""

    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    success: ClassVar[tuple[str, ...]] = ("good",)

    async def run(self, ctx: Context) -> Outcome:
        """End."""
        return Outcome("done")


@pytest.mark.parametrize(
    ("state", "says"),
    [
        (Silent, "declares no outcomes"),
        (Inert, "it has no `run`"),
        (Blocking, "is not a coroutine"),
        (Positional, "`part` of `run` is positional"),
        (Untyped, "`part` of `run` has no type"),
        (Dangling, "`good`, which is not one of its outcomes"),
    ],
)
def test_a_class_that_breaks_the_rules_is_refused_by_name(state: type[State], says: str) -> None:
    """The error names the class, the rule and the remedy."""
    with pytest.raises(StateError) as refusal:
        read_signature(state)
    assert says in str(refusal.value)
    assert state.__qualname__ in str(refusal.value.where)
    assert refusal.value.hint
