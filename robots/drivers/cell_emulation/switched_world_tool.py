"""A tool of the world behind digital outputs: the valve or relay between the outputs of a controller and the tool."""

from __future__ import annotations

from robots.drivers.emulation.plant import ToolPlant
from robots.switched.switched_options import SwitchedToolOptions


class SwitchedWorldTool:
    """Switches a tool as the wires in the options of its driver say; all outputs are off at first.

    Args:
        options: The wires.
        owner: Name of the device with the outputs.
        tool: The tool in the world.
    """

    def __init__(self, options: SwitchedToolOptions, *, owner: str, tool: ToolPlant) -> None:
        self.owner = owner
        self._options = options
        self._tool = tool
        self._values: dict[int, bool] = {}
        self._closed: bool | None = None

    def take(self, output: int, *, on: bool) -> None:
        """Take the value of an output; a valve with two coils stays where it is until one of them is on."""
        self._values[output] = on
        hold, release = self._options.hold_output, self._options.release_output
        if output not in (hold, release):
            return
        closed = self._values.get(hold, False) != self._options.inverted
        if release is not None and closed == self._values.get(release, False):
            return
        if closed != self._closed:
            self._closed = closed
            self._tool.close_to(1.0 if closed else 0.0)
