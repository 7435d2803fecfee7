"""What an emulated controller controls: the joints of an arm and a tool, alone or in a physical world.

An emulator without a plant has joints of its own, which follow exactly. All methods belong to its event loop.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from robots.port import Array


@dataclass(frozen=True, kw_only=True)
class ToolMeasurement:
    """A measured tool: 0 open to 1 closed, whether it moves, and whether something keeps it from its target.

    `force_share` is the force beyond that for closing equally far on nothing, of the greatest; 0 if it is not measured.
    """

    closed_share: float
    moving: bool
    blocked: bool
    force_share: float = 0.0


class ArmPlant(Protocol):
    """The joints of an arm behind its servo amplifiers; angles are those of the controller, rad, (n,)."""

    @property
    def problem(self) -> str:
        """Why the joints do not follow; empty if they do."""
        ...

    def follow(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Set the joints' set point and its velocity; call it in each cycle of the controller."""
        ...

    def carry(self, mass_kg: float) -> None:
        """Compensate the weight of a load at the tool."""
        ...

    def measured(self) -> tuple[Array, Array]:
        """Return the measured positions and velocities."""
        ...

    def reset(self) -> None:
        """End a problem: hold where the joints are."""
        ...


class ToolPlant(Protocol):
    """The motor or the switch of a tool, which is closed when it holds."""

    def close_to(self, closed_share: float, *, speed_share: float = 1.0, force_share: float = 1.0) -> None:
        """Move to a share, as fast and with as much force as these shares of the tool's greatest allow."""
        ...

    def stop(self) -> None:
        """Stop where it is; what is held stays held."""
        ...

    def home(self) -> None:
        """Find both ends of the travel and end open, as an activation does."""
        ...

    def measured(self) -> ToolMeasurement:
        """Return the measured state."""
        ...


class PlantClock(Protocol):
    """The time that passes for the controller and for what it moves."""

    def now_s(self) -> float:
        """Return the present time."""
        ...

    async def sleep_until(self, time_s: float) -> None:
        """Return at this time, or at once if it has passed; other tasks get their turn in either case."""
        ...


class RealClock:
    """Implements `PlantClock` on the monotonic clock."""

    def now_s(self) -> float:
        """Return the monotonic time."""
        return time.monotonic()

    async def sleep_until(self, time_s: float) -> None:
        """Sleep."""
        await asyncio.sleep(max(0.0, time_s - time.monotonic()))


class OutputListener(Protocol):
    """What is connected to the digital outputs of a controller."""

    def __call__(self, output: int, *, on: bool) -> None:
        """Hear of an output that was turned on or off."""
        ...


def unconnected(output: int, *, on: bool) -> None:
    """Implement `OutputListener` where nothing is connected."""


PlantInputs = Callable[[], Mapping[int, bool]]
"""Returns the values of the digital inputs that something in the plant is connected to."""


def nothing_sensed() -> Mapping[int, bool]:
    """Implement `PlantInputs` where nothing is connected."""
    return {}


@dataclass(frozen=True, kw_only=True)
class Plant:
    """What a device consists of beside its controller; None for what it does not have, or what another one moves.

    `on_output` hears of the digital outputs, and `inputs` tells the digital inputs, by the numbers of the driver.
    """

    arm: ArmPlant | None = None
    tool: ToolPlant | None = None
    on_output: OutputListener = unconnected
    inputs: PlantInputs = nothing_sensed
    clock: PlantClock = field(default_factory=RealClock)


ALONE = Plant()
"""An emulator that moves joints of its own."""
