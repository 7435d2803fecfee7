"""The contract of a driver: its options, what it can do and what was proven, and the device that it makes."""

from __future__ import annotations

import importlib
import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, cast

from engine.cell.drivers.device_context import DeviceContext
from engine.cell.drivers.device_report import DeviceReport
from engine.clock import Clock
from engine.document import StrictModel
from engine.robot import Reconnectable, Robot
from engine.skill import CAPABILITIES, Capability, required_capability

_log = logging.getLogger("flexcell.devices")


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
"""Receives the options, `name` (the bus namespace), `clock` and `context`; returns the device, not yet connected."""


@dataclass(frozen=True, kw_only=True)
class Driver:
    """A driver, as the entry point `flexcell.drivers` of its name offers it.

    Attributes:
        kind: Its name, the tag of `options`.
        drives: `arm`, `equipment`, or the kind of tool (`engine.cell.tool_kind`).
        models: Names of the models that it can drive; empty if it can drive any.
        options: The keys of `driver:` in the cell document.
        capabilities: What it can do; a skill beyond them is refused with the reason.
        missing_skills: Skills that it cannot do in spite of its capabilities, with the reasons.
        enabling: What enabling the device does at it, and what a person has to do there, in plain sentences.
        digital_outputs: Returns how many outputs the controller has with these options; None where the model of the
            arm says it.
        digital_inputs: The same of inputs.
        ports: The default TCP ports of the device, by what they are for.
        proven: What was tested against what, and that it never ran on hardware, if so.
        page: Path of its documentation.
        device: Where the maker of its device is found, `module:NAME`.
        capabilities_with: Returns what it can do with some options, where that depends on them; None where it does not.
        not_captured: Which of its connections `--capture` cannot reach, and what can; empty if it has all.
    """

    kind: str
    drives: str
    options: type[DriverOptions]
    capabilities: frozenset[Capability]
    proven: str
    page: str
    device: str
    models: frozenset[str] = frozenset()
    missing_skills: Mapping[str, str] = field(default_factory=dict[str, str])
    enabling: str = "Permits motion."
    digital_outputs: Callable[[Any], int] | None = None
    digital_inputs: Callable[[Any], int] | None = None
    ports: Mapping[str, int]
    not_captured: str = ""
    capabilities_with: Callable[[Any], frozenset[Capability]] | None = None

    def configured(self, options: DriverOptions) -> Driver:
        """Return the driver with what it can do with these options."""
        if self.capabilities_with is None:
            return self
        return replace(self, capabilities=self.capabilities_with(options))

    def new_device(self, options: DriverOptions, *, name: str, clock: Clock, context: DeviceContext) -> DrivenDevice:
        """Return the device, not yet connected.

        Raises:
            CellError: it cannot be driven as the options or the clock say.
        """
        module, _, attribute = self.device.partition(":")
        maker = cast("DeviceMaker", getattr(importlib.import_module(module), attribute))
        if context.capture is not None and self.not_captured:
            _log.warning("the capture of %s is not complete: %s", name, self.not_captured)
        return maker(options, name=name, clock=clock, context=context)

    def lacks(self, capability: Capability | None) -> str:
        """Return why something that needs a capability is refused; empty if the driver has it, or None is needed."""
        if capability is None or capability in self.capabilities:
            return ""
        has = ", ".join(words for name, words in CAPABILITIES.items() if name in self.capabilities)
        return f"the driver {self.kind} has no {CAPABILITIES[capability]}, only {has or 'readings'}"

    def lacks_for_skill(self, skill: str) -> str:
        """Return why a skill is refused, by its name on the bus; empty if the driver can do it."""
        return self.missing_skills.get(skill, "") or self.lacks(required_capability(skill))
