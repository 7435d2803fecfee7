"""Hand guiding of the arm and recording of the demonstration (RCL 4.1.2, RCY 7.1)."""

from __future__ import annotations

import asyncio

import msgspec
import numpy as np

from engine.bus import ActiveGoal, SkillBus
from engine.errors import FlexcellError, GoalRejected, SkillFailed
from engine.skills.entries import WriteEntry
from engine.skills.guiding import FinishGuiding, FinishGuidingResult, GuideArm, GuideFeedback, GuideResult
from engine.store import verify_name
from robots.arm.demonstration import MOST_SAMPLES, DemonstrationRecorder
from robots.arm.execution.monitored_stream import MonitoredStream
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.stopping_path import BRAKING_SHARE, stopping_path
from robots.arm.execution.stream_deadline import StreamDeadline
from robots.arm.scene_queries.path_guard import PathGuard, PathRules
from robots.port import Array, JointTrajectory, MotionStream

_STORE, _KIND = "store", "trajectory"
# External torque along a motion, above its noise and what the arm does not know of its weight.
_PUSH_NM = 2.0


class GuidingMotions:
    """Serves GuideArm and FinishGuiding."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner
        self._bus: SkillBus | None = None
        self._stream: MotionStream | None = None

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills under the arm's name; any client may finish."""
        name = self._runner.name
        self._bus = bus
        bus.advertise_action(GuideArm, self._guide, namespace=name, exclusive=name)
        bus.advertise_service(FinishGuiding, self._finish, namespace=name)

    async def _finish(self, request: FinishGuiding) -> FinishGuidingResult:
        stream = self._stream
        if stream is None:
            raise SkillFailed("the arm is not being guided", where=self._runner.name, hint="send guide_arm first")
        stream.finish()
        await stream.report()
        return FinishGuidingResult(joints=self._runner.measured())

    async def _guide(self, goal: GuideArm, handle: ActiveGoal[GuideFeedback]) -> GuideResult:
        runner = self._runner
        if goal.record:
            self._check_record(goal, handle)
        guard = runner.path_guard if goal.collisions.avoid else None
        rules, hand = PathRules(), _Hand(runner)
        if guard is not None:
            rules = await runner.planned(handle, lambda joints: _rules(guard, joints, hand, goal))
        else:
            runner.accept(handle)
        demonstration = DemonstrationRecorder(runner, handle, sample_s=goal.sample_s)
        deadlines: list[StreamDeadline] = []
        sampling: list[asyncio.Task[None]] = []

        def start() -> MotionStream:
            stream: MotionStream = runner.port.guide(damping=goal.damping)
            if guard is not None:
                stream = MonitoredStream(stream, rules, guard=guard, ahead=hand.ahead, may_resume=hand.has_let_go)
            self._stream = stream
            deadlines.append(StreamDeadline(stream, handle, clock=runner.clock, duration_s=goal.duration_s))
            if goal.record:
                sampling.append(asyncio.create_task(demonstration.run(), name=f"demonstration on {runner.name}"))
            return stream

        def publish_feedback(stream: MotionStream) -> None:
            deadlines[0].look()
            if demonstration.full:
                stream.finish()
            handle.feedback(
                GuideFeedback(
                    joints=runner.measured(),
                    pose=runner.measured_pose(),
                    samples=demonstration.count,
                    held_by=stream.held_by if isinstance(stream, MonitoredStream) else "",
                )
            )

        try:
            ended = await runner.carry_out(start, handle, publish_feedback, mode="guiding")
        finally:
            self._stream = None
            for count in deadlines:
                count.close()
            for task in sampling:
                task.cancel()
                await asyncio.wait((task,))
        entry = goal.record if goal.record and not handle.cancel_requested else ""
        if entry:
            await self._write(entry, demonstration, handle)
        return GuideResult(
            joints=runner.measured(),
            pose=runner.measured_pose(),
            samples=demonstration.count,
            duration_s=ended.duration_s,
            entry=entry,
        )

    def _check_record(self, goal: GuideArm, handle: ActiveGoal[GuideFeedback]) -> None:
        """Reject a goal whose demonstration could not be stored afterwards."""
        assert self._bus is not None
        try:
            verify_name(_KIND, goal.record)
            self._bus.request_type(f"{_STORE}/{WriteEntry.skill_name()}")
        except FlexcellError as error:
            raise GoalRejected(
                f"the demonstration cannot be stored: {error.message}", where=handle.address, hint=error.hint
            ) from None
        if goal.duration_s is not None and goal.duration_s / goal.sample_s > MOST_SAMPLES:
            raise GoalRejected(
                f"{goal.duration_s:g} s with a sample every {goal.sample_s:g} s do not fit into an entry",
                where=handle.address,
                hint=f"record at most {MOST_SAMPLES} samples",
            )

    async def _write(self, entry: str, demonstration: DemonstrationRecorder, handle: ActiveGoal[GuideFeedback]) -> None:
        assert self._bus is not None
        if demonstration.count < 2:
            raise SkillFailed(
                "the demonstration is too short to be stored: it needs at least 2 samples", where=handle.address
            )
        value = msgspec.to_builtins(demonstration.trajectory())
        try:
            await self._bus.call(WriteEntry(kind=_KIND, name=entry, value=value), to=_STORE)
        except FlexcellError as error:
            raise SkillFailed("the demonstration was not stored", where=handle.address) from error


class _Hand:
    """The hand that leads an arm: where the arm gets with it, and whether it still pushes there."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner
        self._velocity = np.zeros(runner.model.dof)

    def ahead(self) -> JointTrajectory:
        """Return the path on with the velocity of the arm for the reaction time, then to rest."""
        sample = self._runner.port.sample()
        self._velocity = velocity = sample.velocity_rad_s.copy()
        return stopping_path(
            sample.position_rad.copy(),
            velocity,
            requested=lambda _: velocity,
            braking_rad_s2=np.array(self._runner.model.limits.acceleration_rad_s2) * BRAKING_SHARE,
        )

    def has_let_go(self) -> bool:
        """Return whether the hand no longer pushes the way that the last path led."""
        external, fastest = self._runner.port.sample().external_nm, float(np.abs(self._velocity).max())
        if len(external) != len(self._velocity) or fastest == 0.0:
            return True
        return float(external @ self._velocity) / fastest < _PUSH_NM


async def _rules(guard: PathGuard, joints: Array, hand: _Hand, goal: GuideArm) -> PathRules:
    """Return the contacts that are meant, when the planners answer."""
    await guard.workspace.ready()
    rules = await guard.rules_at(joints, options=goal.collisions, tool_contact="along_path", person_at_arm=True)
    await guard.check(hand.ahead(), rules, from_s=0.0)
    return rules
