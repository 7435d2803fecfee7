"""The connection to a real arm, as the device of the cell uses it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from engine.cell.drivers import DeviceReport
from robots.port import ArmPort
from robots.port.inputs import InputPort
from robots.port.outputs import OutputPort

NORMAL = "normal"


@dataclass(frozen=True, kw_only=True)
class ControllerFacts:
    """What a controller says of itself, and how fresh that is.

    Attributes:
        readings: How many measurements have come since it was opened.
        age_s: Age of the last one; infinite without any.
        firmware: Empty where it says nothing.
        safety: Why it does not move, by name; `normal` while it can, empty where it does not say.
        speed_scaling: Share of the commanded speed that it permits; None where it does not say.
    """

    readings: int
    age_s: float
    firmware: str = ""
    safety: str = ""
    speed_scaling: float | None = None


class ArmConnection(Protocol):
    """Belongs to the event loop. Connects and reads; moves only after `enable`, which a person asks for."""

    @property
    def port(self) -> ArmPort:
        """Measures and commands the arm; what the controller cannot do raises RobotError with the reason."""
        ...

    @property
    def outputs(self) -> OutputPort | None:
        """The digital outputs of its controller, read back; None without any."""
        ...

    @property
    def inputs(self) -> InputPort | None:
        """The digital inputs of its controller; None where the driver reads none."""
        ...

    @property
    def problem(self) -> str:
        """Why the arm may not move at present, by name and with what to do; empty if it may."""
        ...

    @property
    def lost_reason(self) -> str:
        """Why the connection is lost; empty while it is connected."""
        ...

    def facts(self) -> ControllerFacts:
        """Return what the controller says of itself; the last of it after a loss."""
        ...

    def when_changed(self, callback: Callable[[], None]) -> None:
        """Call `callback`, on the event loop, when `problem`, `lost_reason` or `safety` of the facts changes."""
        ...

    async def open(self) -> None:
        """Connect and return with the first measurement; commands nothing.

        Raises:
            RobotError: the controller does not answer; the hint says what to check.
        """
        ...

    async def enable(self) -> None:
        """Permit motion: sets tool, payload and watchdog again, and clears what a client may clear.

        Unlocks no protective or emergency stop: a person does that at the robot.

        Raises:
            RobotError: it cannot move; the message names the cause.
        """
        ...

    async def report(self, *, readings: int) -> DeviceReport:
        """Read this many times, without commanding it, and return what the controller says."""
        ...

    async def close(self) -> None:
        """Bring the arm to rest and disconnect."""
        ...
