"""Devices of a cell on the bus, each under its own name: `vice/jaws/move_device`, and its `vice/jaws/state`."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.messages import Message
from engine.skill import Action, Service
from engine.skills.switch_result import SwitchResult

DeviceEnd = Literal["reached", "timed", "no_air", "stuck", "sensor_contradicts", "interlocked", "canceled"]
UNKNOWN = "unknown"
"""What is sensed of a device where nothing tells its positions."""
BETWEEN = "between"
"""What is sensed where sensors tell that it is at none of its positions."""


class DeviceReading(Message, frozen=True, kw_only=True):
    """What a device was told, and what is known of it; the latest value of `<device>/state`.

    `commanded` is the last position that was asked for, empty before the first. `sensed` is the position that sensors
    tell, `between`, or `unknown` where the device has no sensors for it. `timed` is true once the time of the commanded
    position has passed. `axes` are the places of simulated axes in m or rad, for people and pages: no state decides by
    them, as real devices do not measure them.
    """

    commanded: str = ""
    sensed: str = UNKNOWN
    moving: bool = False
    timed: bool = False
    outputs: dict[str, bool] = {}
    sensors: dict[str, bool] = {}
    axes: dict[str, float] = {}
    problem: str = ""


class DeviceFeedback(Message, frozen=True, kw_only=True):
    """The step of the sequence, from 1, of how many, and the places of simulated axes."""

    step: int
    steps: int
    axes: dict[str, float] = {}


class DeviceResult(Message, frozen=True, kw_only=True):
    """How a motion ended; with `timed` its time has passed and nothing tells that it is there.

    `reason` is why it did not reach its position; the outputs keep the values of the last step.
    """

    ended: DeviceEnd
    sensed: str
    reason: str = ""


class MoveDevice(Action[DeviceResult, DeviceFeedback], frozen=True, kw_only=True):
    """Move a device to one of its positions; succeeds as an action whether or not it gets there.

    A cancel ends the sequence and leaves the outputs as they are: a cylinder under air goes on to its end.
    """

    position: Annotated[str, Meta(min_length=1, description="Name of the position")]


class ReadDevice(Service[DeviceReading], frozen=True, kw_only=True):
    """Return what is known of a device."""


class DeviceFault(Message, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A fault of a simulated device; none with no field set. It stays until another is set.

    `air: false`: nothing presses. `power: false`: no belt runs. `stuck`: this axis or belt stays where it is,
    or `brakes` stay closed. `sensor`: it says `reads` whatever is true. `brakes: false`: locked legs of its hexapod, or
    the locked carriage of its linear unit, hold no more than released ones.
    """

    air: bool = True
    power: bool = True
    stuck: Annotated[str, Meta(description="Name of an axis or belt of the device, or `brakes`")] = ""
    sensor: Annotated[str, Meta(description="Name of a sensor of the device")] = ""
    reads: bool = False
    brakes: bool = True


class SimulateDeviceFault(Service[SwitchResult], frozen=True, kw_only=True):
    """Set the fault of a simulated device; real devices do not offer it."""

    fault: DeviceFault = DeviceFault()
