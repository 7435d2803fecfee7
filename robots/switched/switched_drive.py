"""What moves a switched tool, and what is known of it: the commanded state, and a part that a sensor detects."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from engine.errors import RobotError
from engine.messages import HoldEvidence
from engine.skills.part_label import UNKNOWN_BODY
from robots.port import NamedOutputs, SwitchableOutputs
from robots.sim.grip.tool_summary import ToolSummary
from robots.switched.switch_motion import SwitchMotion
from robots.switched.switched_options import SwitchedToolOptions


@dataclass(frozen=True, kw_only=True)
class SwitchReading:
    """A tool as its outputs say.

    Attributes:
        time_s: Monotonic time.
        holds: Whether the outputs let it hold.
        hold_share: 0 released to 1 holding; in between by the time that has passed, and not measured.
        contact: `?` where a part counts as held, empty where none does.
        evidence: What tells it.
    """

    time_s: float
    holds: bool
    hold_share: float
    contact: str
    evidence: HoldEvidence


class SwitchedDrive:
    """Belongs to the event loop.

    Args:
        name: Bus name of the tool, for messages.
        options: Its outputs and times.
        tool: Range and force of its model.
        outputs: Returns the outputs of the other device; raises RobotError without any.
        detected: Returns whether the sensor detects a part; None while it has said nothing.
        blocked: Returns why it may not be switched; empty if it may.
    """

    def __init__(
        self,
        name: str,
        options: SwitchedToolOptions,
        *,
        tool: ToolSummary,
        outputs: Callable[[], SwitchableOutputs],
        detected: Callable[[], bool | None],
        blocked: Callable[[], str],
    ) -> None:
        self.name = name
        self.tool = tool
        self._options = options
        self._outputs = outputs
        self._detected = detected
        self._blocked = blocked
        self._motion: SwitchMotion | None = None

    @property
    def motion(self) -> SwitchMotion | None:
        """The active motion."""
        return self._motion if self._motion is not None and not self._motion.ended else None

    def start(self, *, holds: bool) -> SwitchMotion:
        """Switch it.

        Raises:
            RobotError: it may not be switched, or is being switched.
        """
        reason = self._blocked()
        if reason:
            raise RobotError(reason, where=self.name, hint="a person enables it: `enable_device`")
        if self.motion is not None:
            raise RobotError("another motion is active", where=self.name, hint="wait for its end")
        duration_s = self._options.hold_s if holds else self._options.release_s
        self._motion = SwitchMotion(lambda: self._switch(holds=holds), duration_s=duration_s)
        return self._motion

    def reading(self) -> SwitchReading:
        """Return what is known of it; raises RobotError where its outputs are not known."""
        outputs, held = self._outputs(), self._options.hold_output
        holds = self._options.holds(on=outputs.values[number_of(held, outputs, where=self.name)])
        passed = self.motion.progress if self.motion is not None else 1.0
        detected, evidence = self._detection()
        return SwitchReading(
            time_s=time.monotonic(),
            holds=holds,
            hold_share=passed if holds else 1.0 - passed,
            contact=UNKNOWN_BODY if holds and passed == 1.0 and detected else "",
            evidence=evidence,
        )

    def _detection(self) -> tuple[bool, HoldEvidence]:
        if self._options.sensor is None:
            return self._options.assume_held, "not measured"
        return bool(self._detected()), "sensor"

    async def _switch(self, *, holds: bool) -> None:
        outputs = self._outputs()
        for output, on in self._options.outputs(holds=holds).items():
            await outputs.switch(number_of(output, outputs, where=self.name), on=on)


def number_of(output: int | str, outputs: SwitchableOutputs, *, where: str) -> int:
    """Return the present number of an output; raises RobotError where there is none."""
    names: Mapping[str, int] = outputs.names if isinstance(outputs, NamedOutputs) else {}
    number = names.get(output, -1) if isinstance(output, str) else output
    if not 0 <= number < len(outputs.values):
        known = ", ".join(names) or f"0 to {len(outputs.values) - 1}"
        raise RobotError(f"there is no output {output}", where=where, hint=f"there are the outputs {known}")
    return number
