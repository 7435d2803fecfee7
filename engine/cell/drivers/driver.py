"""The contract of a driver: its options, what it can do and what was proven, and the device that it makes."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol, cast

from engine.cell.drivers.capabilities import CAPABILITIES, SKILL_CAPABILITIES, Capability
from engine.cell.drivers.device_report import DeviceReport
from engine.clock import Clock
from engine.document import StrictModel
from engine.robot import Reconnectable, Robot


class DriverOptions(StrictModel, frozen=True, kw_only=True, tag_field="kind"):
    """Base of the options of drivers; the tag of a subclass is the driver's name, `kind` in the cell document."""


class DrivenDevice(Robot, Reconnectable, Protocol):
    """A real device as its driver makes it.

    Entering it connects and reads, and commands nothing. Leaving it ends the motions that it started. After a lost
    connection it reads again by itself; motion needs `reconnect` and the skill `EnableDevice`, both a person's command.
    """

    async def report(self, *, readings: int) -> DeviceReport:
        """Read the device this many times, without commanding it, and return what it says; it is entered."""
        ...


DeviceMaker = Callable[..., DrivenDevice]
"""Receives the options, `name` (the bus namespace) and `clock`, and returns the device, not yet connected."""


@dataclass(frozen=True, kw_only=True)
class Driver:
    """A driver, as the entry point `flexcell.drivers` of its name offers it.

    Attributes:
        kind: Its name, the tag of `options`.
        drives: `arm`, or the kind of tool (`engine.cell.tool_kind`).
        models: Names of the models that it can drive; empty if it can drive any.
        options: The keys of `driver:` in the cell document.
        capabilities: What it can do; a skill beyond them is refused with the reason.
        ports: The default TCP ports of the device, by what they are for.
        proven: What was tested against what, and that it never ran on hardware, if so.
        page: Path of its documentation.
        device: Where the maker of its device is found, `module:NAME`.
    """

    kind: str
    drives: str
    options: type[DriverOptions]
    capabilities: frozenset[Capability]
    proven: str
    page: str
    device: str
    models: frozenset[str] = frozenset()
    ports: Mapping[str, int]

    def new_device(self, options: DriverOptions, *, name: str, clock: Clock) -> DrivenDevice:
        """Return the device, not yet connected.

        Raises:
            CellError: it cannot be driven as the options or the clock say.
        """
        module, _, attribute = self.device.partition(":")
        maker = cast("DeviceMaker", getattr(importlib.import_module(module), attribute))
        return maker(options, name=name, clock=clock)

    def lacks(self, capability: str) -> str:
        """Return why something that needs a capability is refused; empty if the driver has it."""
        if capability in self.capabilities:
            return ""
        needed = next((words for name, words in CAPABILITIES.items() if name == capability), "")
        has = ", ".join(words for name, words in CAPABILITIES.items() if name in self.capabilities)
        return f"the driver {self.kind} has no {needed}, only {has or 'readings'}" if needed else ""

    def lacks_for_skill(self, skill: str) -> str:
        """Return why a skill is refused, by its name on the bus; empty if the driver can do it."""
        return self.lacks(SKILL_CAPABILITIES.get(skill, ""))
