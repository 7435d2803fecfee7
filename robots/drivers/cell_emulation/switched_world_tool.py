"""A tool of the world behind digital outputs: the valve or relay, and the sensor at the tool that detects a part."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from robots.drivers.emulation.plant import ToolPlant
from robots.switched.switched_options import SwitchedToolOptions


class SwitchedWorldTool:
    """Switches a tool as the wires in the options of its driver say; all outputs are off at first.

    Args:
        options: The wires.
        owner: Name of the device with the outputs.
        tool: The tool in the world.
        holds: Returns whether it holds a part there.
    """

    def __init__(
        self, options: SwitchedToolOptions, *, owner: str, tool: ToolPlant, holds: Callable[[], bool] = lambda: False
    ) -> None:
        self.owner = owner
        self._options = options
        self._tool = tool
        self._holds = holds
        self._values: dict[int | str, bool] = {}
        self._closed: bool | None = None

    def sensed(self) -> Mapping[int, bool]:
        """Return the input that its sensor is wired to with its value, nothing without such a sensor."""
        sensor = self._options.sensor
        if sensor is None or not isinstance(sensor.input, int):
            return {}
        return {sensor.input: self._holds() != sensor.inverted}

    def take(self, output: int, *, on: bool) -> None:
        """Take the value of an output; a valve with two coils stays where it is until one of them is on."""
        self._values[output] = on
        hold, release = self._options.hold_output, self._options.release_output
        if output not in (hold, release):
            return
        closed = self._options.holds(on=self._values.get(hold, False))
        if release is not None and closed == self._values.get(release, False):
            return
        if closed != self._closed:
            self._closed = closed
            self._tool.close_to(1.0 if closed else 0.0)
