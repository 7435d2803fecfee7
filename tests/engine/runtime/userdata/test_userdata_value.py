"""What states may write: nothing that a journal would change, nothing that somebody else can change behind a scope."""

from __future__ import annotations

import asyncio
import math
import threading
from typing import Any, ClassVar

import msgspec
import pytest
from hypothesis import given

from engine.errors import UserdataError
from engine.runtime.userdata.userdata import Scope
from engine.runtime.userdata.userdata_value import plain_value
from engine.state import Context, Outcome, State
from tests.engine.json_values import JSON
from tests.engine.runtime.control.operate import operate


class Part(msgspec.Struct, frozen=True, kw_only=True):
    """Cannot be changed, but what is in it can."""

    holes: list[int]


def _in_itself() -> list[object]:
    made: list[object] = []
    made.append(made)
    return made


REFUSED: dict[str, tuple[object, str]] = {
    "NaN": (math.nan, "the number nan"),
    "infinity, inside": ({"a": [1.0, {"b": -math.inf}]}, "the number -inf (at a[1].b)"),
    "bytes": (b"ab", "a value of type bytes"),
    "a set": ([{1, 2}], "a value of type set (at [0])"),
    "number as key": ({1: 2}, "a mapping with the key 1"),
    "half a character": ("\ud800", "text with a lone surrogate"),
    "half a character as key": ({"\ud800": 1}, "a mapping with the key"),
    "a lock": (threading.Lock(), "a value of type lock"),
    "in a struct": (Part(holes=[math.nan]), "the number nan (at holes[0])"),  # type: ignore[list-item]
    "in itself": (_in_itself(), "nested too deeply or contains itself"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_a_journal_would_change_is_refused_where_it_is_written(name: str) -> None:
    value, said = REFUSED[name]
    with pytest.raises(UserdataError) as refused:
        plain_value(value, key="k", where="root/here")
    assert said in refused.value.message
    assert refused.value.where == "root/here"


@given(value=JSON)
def test_what_is_taken_comes_back_from_a_journal_as_it_was(value: object) -> None:
    assert msgspec.json.decode(msgspec.json.encode(plain_value(value, key="k", where="root"))) == value


def test_what_is_in_a_frozen_struct_is_nobody_elses() -> None:
    scope = Scope("", {})
    part = Part(holes=[1])
    scope.write("part", part)
    part.holes.append(2)
    read = scope.read("part", reader="root")
    assert read == Part(holes=[1])
    assert isinstance(read, Part)
    read.holes.append(3)
    assert scope.read("part", reader="root") == Part(holes=[1])


class GiveAway(State, frozen=True, kw_only=True):
    """Write something that cannot be kept."""

    state_name: ClassVar[str] = "test.GiveAway"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    outputs: ClassVar[dict[str, Any]] = {"value": object}

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("done", {"value": threading.Lock()})


class Leave(State, frozen=True, kw_only=True):
    """Raise what ends programs."""

    state_name: ClassVar[str] = "test.Leave"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        await asyncio.sleep(0)
        raise SystemExit(3)


ONE = """
root:
  machine:
    initial: one
    states:
      one: {state: NAME, on_error: good, retry: {times: 1, outcomes: [], errors: true}, transitions: {done: bad}}
"""


@pytest.mark.parametrize("kind", [GiveAway, Leave])
def test_it_is_an_error_of_its_node_like_any_other(kind: type[State]) -> None:
    told = operate(ONE.replace("NAME", kind.state_name), {}, states={kind.state_name: kind})
    assert (told.result.status, told.result.outcome) == ("finished", "good")
    assert sum(line.startswith("+root/one") for line in told.lines) == 2


def test_the_message_names_the_node() -> None:
    told = operate(ONE.replace("NAME", "test.Leave").replace("on_error: good, ", ""), {}, states={"test.Leave": Leave})
    assert told.result.cause is not None
    said = str([(each.message, each.where) for each in told.result.cause.chain()])
    assert "test.Leave raised SystemExit: 3" in said
    assert "root/one" in said or "test.yaml:" in said
