"""Direct joint control: follows set points from a topic and rejects every other goal (RCL 4.3.8, table 9)."""

from __future__ import annotations

import logging

from engine.bus import SkillBus
from engine.errors import RobotError
from engine.skills.direct_control import JointCommand, SwitchDirectControl
from engine.skills.switch_result import SwitchResult
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.validate_numbers import are_numbers
from robots.port import MotionEnd, MotionStream

_log = logging.getLogger("flexcell.arm")
_WORDS = "direct joint control"


class DirectControl:
    """Serves SwitchDirectControl and subscribes to `<arm>/direct_joints`."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner
        self._bus: SkillBus | None = None
        self._stream: MotionStream | None = None

    def register(self, bus: SkillBus) -> None:
        """Advertise the service under the arm's name; while a run holds the lease on the arm, only it may call it."""
        name = self._runner.name
        self._bus = bus
        bus.advertise_service(SwitchDirectControl, self._switch, namespace=name, commands=name)
        bus.topic(f"{name}/direct_joints", JointCommand).subscribe_commands(self._take)

    @property
    def on(self) -> bool:
        """True while the arm follows set points."""
        return self._stream is not None and self._runner.reserved_for == _WORDS

    async def _switch(self, request: SwitchDirectControl) -> SwitchResult:
        if request.on:
            return self._turn_on(request.watchdog_s)
        return await self._turn_off()

    def _turn_on(self, watchdog_s: float) -> SwitchResult:
        runner = self._runner
        if self.on:
            return SwitchResult(success=True, message=f"{_WORDS} is already on")
        reason, hint = runner.obstacle()
        if runner.busy:
            reason, hint = f"the arm is busy with {runner.activity or 'a goal'}", "wait for its end or cancel it"
        if reason:
            return SwitchResult(success=False, message=f"{reason} ({hint})")
        try:
            stream = runner.port.stream("joint_position", watchdog_s=watchdog_s)
        except RobotError as error:
            return SwitchResult(success=False, message=str(error))
        self._stream = stream
        runner.occupy(stream, mode="direct", activity=SwitchDirectControl.skill_name(), reserved_for=_WORDS)
        if self._bus is not None:
            # The lease holder turned it on; the stream must not command the arm after the lease ends.
            self._bus.leases.when_freed(runner.name, stream.cancel)
        return SwitchResult(success=True, message=f"{_WORDS} is on")

    async def _turn_off(self) -> SwitchResult:
        stream = self._stream
        if stream is None or not self.on:
            return SwitchResult(success=True, message=f"{_WORDS} is off")
        stream.finish()
        report = await stream.report()
        await self._runner.freed()
        if report.end is MotionEnd.FAILED:
            return SwitchResult(success=True, message=f"{_WORDS} is off: {report.reason}")
        return SwitchResult(success=True, message=f"{_WORDS} is off")

    def _take(self, command: JointCommand) -> None:
        if self._stream is None or not self.on:
            return
        try:
            if not are_numbers(command.position_rad):
                raise RobotError(f"{command.position_rad!r} are not joint angles", where=self._runner.name)
            self._stream.send(command.position_rad)
        except RobotError as error:
            # A topic has no reply to the publisher; the watchdog stops the arm if no valid command follows.
            _log.warning("%s/direct_joints: %s; command ignored", self._runner.name, error)
