"""Parameters of devices: declared once, found by name, every change seen by whoever watches."""

from __future__ import annotations

import pytest

from engine.bus import BusParameter, ParameterServer
from engine.errors import BusError


def test_a_parameter_is_declared_once_with_a_value_of_its_type() -> None:
    parameters = ParameterServer()
    parameters.declare("left/speed", float, 0.5, description="share of the limits")
    with pytest.raises(BusError, match="left/speed: this parameter is already declared"):
        parameters.declare("left/speed", int, 1)
    with pytest.raises(BusError, match="expected number, got text"):
        parameters.declare("left/force", float, "much")
    assert parameters.listing() == (BusParameter("left/speed", float, 0.5, "share of the limits"),)


def test_nothing_is_read_set_or_watched_that_is_not_there() -> None:
    parameters = ParameterServer()
    for wrong in (
        lambda: parameters.get("left/speed"),
        lambda: parameters.set("left/speed", 0.5),
        lambda: parameters.watch("left/speed", print),
    ):
        with pytest.raises(BusError, match="left/speed: no such parameter"):
            wrong()


def test_whoever_watches_a_parameter_sees_its_changes_and_no_others() -> None:
    """The description stays; the listing is sorted by name."""
    parameters, seen, others = ParameterServer(), list[object](), list[object]()
    for name in ("right/speed", "left/speed"):
        parameters.declare(name, float, 0.5, description=name)
    parameters.watch("left/speed", seen.append)
    parameters.watch("left/speed", others.append)
    parameters.set("left/speed", 0.7)
    parameters.set("right/speed", 0.2)
    assert (seen, others) == ([0.7], [0.7])
    assert [(each.name, each.value, each.description) for each in parameters.listing()] == [
        ("left/speed", 0.7, "left/speed"),
        ("right/speed", 0.2, "right/speed"),
    ]
