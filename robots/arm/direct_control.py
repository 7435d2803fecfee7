"""Direct joint control: follows set points from a topic and rejects every other goal (RCL 4.3.8, table 9)."""

from __future__ import annotations

import logging

import numpy as np

from engine.bus import SkillBus
from engine.errors import FlexcellError, RobotError
from engine.skills.direct_control import JointCommand, SwitchDirectControl
from engine.skills.switch_result import SwitchResult
from robots.arm.execution.monitored_stream import MonitoredStream
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.stopping_path import BRAKING_SHARE, REACTION_S, stopping_path
from robots.arm.execution.validate_numbers import are_numbers
from robots.arm.scene_queries.path_guard import PathGuard, PathRules
from robots.port import Array, JointTrajectory, MotionEnd, MotionStream

_log = logging.getLogger("flexcell.arm")
_WORDS = "direct joint control"


class DirectControl:
    """Serves SwitchDirectControl and subscribes to `<arm>/direct_joints`."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner
        self._bus: SkillBus | None = None
        self._stream: MotionStream | None = None
        self._target: Array | None = None

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
        return await (self._turn_on(request) if request.on else self._turn_off())

    async def _turn_on(self, request: SwitchDirectControl) -> SwitchResult:
        runner = self._runner
        if self.on:
            return SwitchResult(success=True, message=f"{_WORDS} is already on")
        if reason := self._unavailable_reason():
            return SwitchResult(success=False, message=reason)
        guard = runner.path_guard if request.collisions.avoid else None
        try:
            if guard is None:
                stream = runner.port.stream("joint_position", watchdog_s=request.watchdog_s)
            else:
                stops, owner = runner.stops, self._owner()
                rules = await self._rules(guard, request)
                reason = self._unavailable_reason()
                if runner.stops != stops:
                    reason = "the arm was stopped or lost meanwhile"
                elif self._owner() != owner:
                    reason = "the lease on the arm has ended, or changed, meanwhile"
                if reason:
                    return SwitchResult(success=False, message=reason)
                stream = self._monitored(guard, rules, request)
        except FlexcellError as error:
            return SwitchResult(success=False, message=str(error))
        self._stream, self._target = stream, None
        runner.occupy(stream, mode="direct", activity=SwitchDirectControl.skill_name(), reserved_for=_WORDS)
        if self._bus is not None:
            # The lease holder turned it on; the stream must not command the arm after the lease ends.
            self._bus.leases.when_freed(runner.name, stream.cancel)
        return SwitchResult(success=True, message=f"{_WORDS} is on")

    def _owner(self) -> str | None:
        return self._bus.leases.owner(self._runner.name) if self._bus is not None else None

    def _unavailable_reason(self) -> str:
        runner = self._runner
        reason, hint = runner.obstacle()
        if runner.busy:
            reason, hint = f"the arm is busy with {runner.activity or 'a goal'}", "wait for its end or cancel it"
        return f"{reason} ({hint})" if reason else ""

    async def _rules(self, guard: PathGuard, request: SwitchDirectControl) -> PathRules:
        """Return the contacts that are meant, when cameras and planners answer."""
        joints = self._runner.port.sample().desired_rad
        async with guard.observed():
            await guard.workspace.ready()
            await guard.workspace.fresh()
            rules = await guard.rules_at(joints, options=request.collisions, tool_contact="never")
            await guard.check(self._ahead(), rules, from_s=0.0)
        return rules

    def _monitored(self, guard: PathGuard, rules: PathRules, request: SwitchDirectControl) -> MotionStream:
        stream = self._runner.port.stream("joint_position", watchdog_s=request.watchdog_s)
        return MonitoredStream(stream, rules, guard=guard, ahead=self._ahead)

    def _ahead(self) -> JointTrajectory:
        """Return the path on to where the set points lead within the reaction time, then to rest."""
        sample, limits = self._runner.port.sample(), self._runner.model.limits
        joints, velocity = sample.desired_rad, sample.velocity_rad_s
        target = joints if self._target is None else self._target
        fastest = np.array(limits.velocity_rad_s)
        towards = np.clip((target - joints) / REACTION_S + velocity, -fastest, fastest)
        return stopping_path(
            joints,
            velocity,
            requested=lambda _: towards,
            braking_rad_s2=np.array(limits.acceleration_rad_s2) * BRAKING_SHARE,
        )

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
            self._target = np.array(command.position_rad)
        except RobotError as error:
            # A topic has no reply to the publisher; the watchdog stops the arm if no valid command follows.
            _log.warning("%s/direct_joints: %s; command ignored", self._runner.name, error)
