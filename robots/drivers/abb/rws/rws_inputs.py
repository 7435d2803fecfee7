"""Signals of an ABB controller as the digital inputs of its arm."""

from __future__ import annotations

from collections.abc import Callable

from robots.drivers.abb.rws.rws_monitor import RwsMonitor
from robots.drivers.arm.controller_inputs import ControllerInputs


def rws_inputs(rws: RwsMonitor | None, *, lost_reason: Callable[[], str]) -> ControllerInputs | None:
    """Return the inputs of an arm, None without any; they are known while neither the arm nor the service is lost."""
    if rws is None or rws.input_count == 0:
        return None
    return ControllerInputs(
        count=rws.input_count, values=lambda: rws.input_values, lost_reason=lambda: lost_reason() or rws.inputs_problem
    )
