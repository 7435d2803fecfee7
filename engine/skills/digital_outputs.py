"""Digital outputs of a robot's controller and the equipment on them (RCL 4.3.9, tables 10 and 11)."""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec

from engine.messages import Message
from engine.skill import Capability, Service
from engine.skills.switch_result import SwitchResult

OutputNumber = Annotated[int, msgspec.Meta(ge=0, description="Number of the output, from 0")]
On = Annotated[bool, msgspec.Meta(description="True to turn on, false to turn off")]


class DigitalOutputs(Message, frozen=True, kw_only=True):
    """All outputs by number; the latest value of `<device>/digital_outputs`.

    `names` are those of equipment, with their numbers. With a `problem` nothing is known, and there are no `values`.
    """

    values: tuple[bool, ...]
    names: dict[str, int] = {}
    problem: str = ""


class SetOutput(Service[SwitchResult], frozen=True, kw_only=True):
    """Turn an output on or off, by its number at a robot, or by its name at equipment."""

    capability: ClassVar[Capability] = "outputs"

    output: OutputNumber | None = None
    name: Annotated[str, msgspec.Meta(description="Name of an output of equipment")] = ""
    value: On

    def __post_init__(self) -> None:
        """Refuse none of both, and both."""
        if (self.output is None) == (not self.name):
            raise ValueError("give either `output` or `name`")


class SetToolExchange(Service[SwitchResult], frozen=True, kw_only=True):
    """Turn the output of the tool exchange on or off."""

    capability: ClassVar[Capability] = "outputs"

    value: On


class SetGripper(Service[SwitchResult], frozen=True, kw_only=True):
    """Turn the output of the gripper on or off."""

    capability: ClassVar[Capability] = "outputs"

    value: On


class SetLinearAxis(Service[SwitchResult], frozen=True, kw_only=True):
    """Turn the output of the linear axis (its brake or drive) on or off."""

    capability: ClassVar[Capability] = "outputs"

    value: On
