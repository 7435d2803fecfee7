"""The options that the drivers of all switched tools have: outputs, times, and what tells that something is held."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from msgspec import Meta

from engine.cell.drivers import DriverOptions
from engine.document import StrictModel

Output = (
    Annotated[int, Meta(ge=0, le=255, description="Number of a digital output, from 0")]
    | Annotated[str, Meta(min_length=1, description="Name of an output of equipment")]
)
Input = (
    Annotated[int, Meta(ge=0, le=255, description="Number of a digital input, from 0")]
    | Annotated[str, Meta(min_length=1, description="Name of an input of equipment")]
)
Seconds = Annotated[float, Meta(ge=0.0, le=30.0, description="Seconds that the tool takes")]


class PartSensor(StrictModel, frozen=True, kw_only=True):
    """What detects a part in the tool: an input of the device with the outputs, or a boolean topic of the cell."""

    topic: Annotated[str, Meta(description="Name of a topic that the cell declares, `line/part_sensor`")] = ""
    input: Input | None = None
    inverted: Annotated[bool, Meta(description="Whether it is false while it detects a part")] = False

    def __post_init__(self) -> None:
        """Refuse none of both, and both."""
        if bool(self.topic) == (self.input is not None):
            raise ValueError("a sensor has either `topic` or `input`")


class SwitchedToolOptions(DriverOptions, frozen=True, kw_only=True):
    """A tool that holds while an output is on, or, with two outputs, from one until the other is switched on.

    Without a sensor nothing tells whether a part is held. With `assume_held` one counts as held while the tool is
    switched to hold, by a person's decision; without it none ever does.
    """

    device: Annotated[
        str, Meta(description="The robot or equipment with the outputs; empty for the arm with the tool")
    ] = ""
    hold_output: Output = 0
    release_output: Annotated[Output | None, Meta(description="Of a valve with two coils: on to release")] = None
    inverted: Annotated[bool, Meta(description="Whether it holds while `hold_output` is off")] = False
    hold_s: Seconds = 0.5
    release_s: Seconds = 0.5
    sensor: PartSensor | None = None
    assume_held: Annotated[bool, Meta(description="Whether a part counts as held although nothing detects it")] = False

    def __post_init__(self) -> None:
        """Refuse outputs and evidence that contradict one another."""
        if self.release_output is not None and (self.inverted or self.release_output == self.hold_output):
            raise ValueError("`release_output` is another output than `hold_output`, and none of them is inverted")
        if self.sensor is not None and self.assume_held:
            raise ValueError("with a `sensor` nothing has to be assumed: leave `assume_held` out")

    def outputs(self, *, holds: bool) -> Mapping[int | str, bool]:
        """Return the values of its outputs, in the order in which they are switched."""
        if self.release_output is None:
            return {self.hold_output: holds != self.inverted}
        ordered = (self.hold_output, self.release_output)
        values = {self.hold_output: holds, self.release_output: not holds}
        # A valve with two coils is never given both: the one that goes off is first.
        return {output: values[output] for output in sorted(ordered, key=lambda output: values[output])}

    def holds(self, *, on: bool) -> bool:
        """Return whether it holds while `hold_output` is on, or off."""
        return on != self.inverted

    def pins(self) -> tuple[int | str, ...]:
        """Return all its outputs, and the input of its sensor."""
        sensed = self.sensor.input if self.sensor is not None else None
        return tuple(pin for pin in (self.hold_output, self.release_output, sensed) if pin is not None)
