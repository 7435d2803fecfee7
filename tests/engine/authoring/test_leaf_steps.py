"""States in Python: what an instance says is what the document says."""

from __future__ import annotations

import datetime as dt
from enum import Enum
from typing import Annotated, ClassVar

import msgspec
import pytest
from msgspec import Meta

from engine.authoring import behavior, expr, parameter, state
from engine.errors import DocumentError
from engine.state import Context, Outcome, State
from tests.engine.fake_states import Give


class Color(Enum):
    RED = "red"


class Point(msgspec.Struct, frozen=True, kw_only=True):
    x: float
    y: float = 0.0
    frame: str = "world"


class Circle(msgspec.Struct, frozen=True, tag="circle"):
    radius: float = 1.0


class Square(msgspec.Struct, frozen=True, tag="square"):
    side: float = 1.0


class Pair(msgspec.Struct, frozen=True, array_like=True):
    left: int
    right: int


class Draw(State, frozen=True, kw_only=True, rename={"points": "at"}):
    """A state with parameters of many types."""

    state_name: ClassVar[str] = "test.Draw"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    points: tuple[Point, ...] = ()
    shape: Circle | Square = Circle()
    speed: Annotated[float, Meta(gt=0)] = 1.0
    anything: object = 1.0
    color: Color = Color.RED
    pair: Pair = Pair(0, 0)
    tags: dict[str, list[str]] = {}
    day: dt.date | None = None

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("done")


class Plain(State, frozen=True, kw_only=True):
    """A state without a name of its own."""

    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    low: float = 0.0
    high: float = 1.0

    def __post_init__(self) -> None:
        if self.low > self.high:
            raise ValueError("`low` is above `high`")

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("done")


def _written(what: State) -> dict[str, object]:
    return behavior("x", outcomes=["done"], root=state(what)).root.parameters


def test_defaults_are_left_out() -> None:
    """At all depths."""
    assert _written(Draw()) == {}
    assert _written(Draw(points=(Point(x=1.0), Point(x=2.0, frame="left")), speed=2.0)) == {
        "at": [{"x": 1.0}, {"x": 2.0, "frame": "left"}],
        "speed": 2.0,
    }


def test_what_only_equals_the_default_is_written() -> None:
    """To a parameter of any type, 1, 1.0 and true are three values."""
    assert [_written(Draw(anything=value)) for value in (1.0, 1, True)] == [{}, {"anything": 1}, {"anything": True}]


def test_values_are_written_as_msgspec_reads_them() -> None:
    """Tags, arrays, dates and nested mappings; reading them back gives the instance again."""
    instance = Draw(
        shape=Square(side=1.0), pair=Pair(1, 2), tags={"a": ["b"]}, day=dt.date(2026, 11, 21), anything=Color.RED
    )
    assert _written(instance) == {
        "shape": {"type": "square"}, "pair": [1, 2], "tags": {"a": ["b"]}, "day": "2026-11-21", "anything": "red",
    }  # fmt: skip
    again = msgspec.convert(_written(instance), Draw)
    assert msgspec.structs.replace(again, anything=Color.RED) == instance


def test_expressions_stand_where_values_do() -> None:
    """At all depths, and in text."""
    speed = parameter("speed", float)
    assert _written(Draw(speed=speed.value, points=(Point(x=expr("size(xs)")),), tags={"a": [f"{speed} m/s"]})) == {
        "at": [{"x": "${size(xs)}"}], "speed": "${speed}", "tags": {"a": ["${speed} m/s"]},
    }  # fmt: skip


def test_parameters_that_do_not_fit_are_refused_where_the_state_is_made() -> None:
    """A struct checks nothing when made; the document would."""
    with pytest.raises(DocumentError, match=r"the parameters of Draw are invalid: .*> 0") as raised:
        state(Draw(speed=-1.0))
    assert "test_leaf_steps.py" in str(raised.value.where)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (float("nan"), "nan is not a finite number"),
        (2**64, "does not fit into 64 bits"),
        ("\ud800", "is not Unicode text"),
        ({1: 2}, "the key 1 is not text"),
        (object(), "a document cannot contain a object"),
        ([{"deep": float("inf")}], "inf is not a finite number"),
    ],
)
def test_what_no_document_can_hold_is_refused(value: object, message: str) -> None:
    """Whether given by instance or by name."""
    for make in (lambda: state(Draw(anything=value)), lambda: state("test.Draw", parameters={"anything": value})):
        with pytest.raises(DocumentError, match=message):
            make()


def test_a_class_is_named_by_its_state_name_else_by_its_place() -> None:
    """As documents name it."""
    assert behavior("x", outcomes=["done"], root=state(Draw)).root.state == "test.Draw"
    assert behavior("x", outcomes=["done"], root=state(Plain(low=0.5))).root.state == f"{__name__}:Plain"


def test_a_class_that_no_document_can_name_is_refused() -> None:
    """It stands inside a function."""

    class Inner(State, frozen=True, kw_only=True):
        outcomes: ClassVar[tuple[str, ...]] = ("done",)

        async def run(self, ctx: Context) -> Outcome:
            return Outcome("done")

    with pytest.raises(DocumentError, match="no document can name the state class"):
        state(Inner())


def test_a_class_that_computes_with_its_fields_takes_expressions_by_name() -> None:
    """An instance of it cannot be made with them."""
    with pytest.raises(TypeError):
        Plain(low=expr("x"))
    made = behavior("x", outcomes=["done"], root=state(Plain, parameters={"low": expr("x")}))
    assert made.root.parameters == {"low": "${x}"}


def test_later_changes_of_a_given_value_change_nothing() -> None:
    """The document is a copy."""
    values = {"outcome": ["a"]}
    step = state("test.Give", parameters=values)
    values["outcome"].append("b")
    made = behavior("x", outcomes=["a"], root=step)
    values["outcome"].append("c")
    assert made.root.parameters == {"outcome": ["a"]}
    assert behavior("x", outcomes=["a"], root=state(Give(outcome="c"))).root.parameters == {"outcome": "c"}
