"""The port of a device: outputs and sensors by name. Behind it is a simulation, or pins."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from engine.bus import Holder


class DevicePort(Protocol):
    """Sets outputs and reads sensors of one device."""

    async def set_output(self, name: str, *, on: bool, holder: Holder) -> None:
        """Turn an output on or off for `holder`, and return when that is confirmed; raises RobotError."""
        ...

    @property
    def outputs(self) -> Mapping[str, bool]:
        """The values of all outputs; raises RobotError where they are not known."""
        ...

    @property
    def sensors(self) -> Mapping[str, bool]:
        """The values of all sensors; raises RobotError where they are not known."""
        ...

    @property
    def axes(self) -> Mapping[str, float]:
        """The places of axes, where something measures them: in simulation; else empty."""
        ...
