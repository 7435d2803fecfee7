"""Outputs of a switched tool: what is set in which order, and what a document may not say."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from robots.standard_tools.switched_gripper_driver import SwitchedGripperOptions


def options(**given: Any) -> SwitchedGripperOptions:
    return msgspec.convert({"kind": "switched_gripper", **given}, SwitchedGripperOptions)


@pytest.mark.parametrize(
    ("given", "hold", "release"),
    [
        ({}, {0: True}, {0: False}),
        ({"hold_output": 3, "inverted": True}, {3: False}, {3: True}),
        ({"release_output": 1}, {1: False, 0: True}, {0: False, 1: True}),
    ],
)
def test_outputs_are_set_and_what_goes_off_is_first(
    given: dict[str, Any], hold: dict[int, bool], release: dict[int, bool]
) -> None:
    chosen = options(**given)
    assert list(chosen.outputs(holds=True).items()) == list(hold.items())
    assert list(chosen.outputs(holds=False).items()) == list(release.items())


@pytest.mark.parametrize(("inverted", "held"), [(False, (False, True)), (True, (True, False))])
def test_what_is_read_back_says_whether_it_holds(inverted: bool, held: tuple[bool, bool]) -> None:
    chosen = options(hold_output=1, inverted=inverted)
    assert (chosen.holds(on=False), chosen.holds(on=True)) == held


def test_all_pins_are_those_of_outputs_and_sensor() -> None:
    assert options(hold_output="close", release_output="open", sensor={"input": "part"}).pins() == (
        "close",
        "open",
        "part",
    )
    assert options().pins() == (0,)


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({"release_output": 0}, "another output"),
        ({"release_output": 1, "inverted": True}, "another output"),
        ({"sensor": {"topic": "line/sensor"}, "assume_held": True}, "nothing has to be assumed"),
        ({"hold_output": -1}, "hold_output"),
    ],
)
def test_what_contradicts_itself_is_refused(given: dict[str, Any], reason: str) -> None:
    with pytest.raises(msgspec.ValidationError, match=reason):
        options(**given)
