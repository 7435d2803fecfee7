"""Skill server of one two-finger gripper: implements the gripper skills over a `GripperPort`, simulated or real."""

from __future__ import annotations

from engine.bus import ActiveGoal, SkillBus
from engine.errors import GoalRejected, SkillFailed
from engine.messages import GripperState
from engine.skills.gripper import (
    GraspResult,
    GripperFeedback,
    GripperGrasp,
    GripperMove,
    GripperOpen,
    GripperSetting,
    ReadGripper,
)
from robots.gripper.tool_motion import ToolMotion
from robots.port import GripperPort, GripperSample
from robots.port.grasp_check import GraspCommand, check_grasp, grasp_evidence, held_part

_MOVE_FORCE_N = 30.0
_AT_WIDTH_M = 0.002


class GripperServer:
    """Serves a gripper under `name`, usually `<arm>/gripper`; owned by its arm's `ArmServer`."""

    def __init__(self, *, name: str, port: GripperPort) -> None:
        self.name = name
        self._port = port
        self._motion = ToolMotion(device=name, words="the gripper")
        self.grip: GraspCommand | None = None
        """The active grasp command; None after any other command."""

    @property
    def moving(self) -> bool:
        """True while a goal is executing."""
        return self._motion.moving

    def register(self, bus: SkillBus) -> None:
        """Advertise the gripper skills."""
        bus.advertise_action(GripperOpen, self._open, namespace=self.name, exclusive=self.name)
        bus.advertise_action(GripperMove, self._move, namespace=self.name, exclusive=self.name)
        bus.advertise_action(GripperGrasp, self._grasp, namespace=self.name, exclusive=self.name)
        bus.advertise_service(ReadGripper, self._read, namespace=self.name)

    async def stop(self) -> None:
        """Stop the fingers where they are; a held object stays held."""
        await self._motion.stop()

    async def _open(self, goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        handle.accept()
        return await self._move_to(self._port.max_width_m, goal.speed_m_s, handle)

    async def _move(self, goal: GripperMove, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        self._refuse_beyond(goal.width_m, handle)
        handle.accept()
        return await self._move_to(goal.width_m, goal.speed_m_s, handle)

    async def _grasp(self, goal: GripperGrasp, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        self._refuse_beyond(goal.width_m, handle)
        if goal.force_n > self._port.max_force_n:
            raise GoalRejected(
                f"a force of {goal.force_n:.0f} N is not possible",
                where=handle.address,
                hint=f"this gripper presses with up to {self._port.max_force_n:.0f} N",
            )
        handle.accept()
        start = self._state()
        self.grip = GraspCommand(
            least_m=goal.width_m - goal.tolerance_inner_m,
            most_m=goal.width_m + goal.tolerance_outer_m,
            force_n=goal.force_n,
        )
        await self._carry_out(0.0, goal.speed_m_s, goal.force_n, handle)
        sample = self._port.sample()
        reason = check_grasp(sample, self.grip)
        return GraspResult(
            held=not reason,
            width_m=sample.width_m,
            force_n=sample.force_n,
            reason=reason,
            start=start,
            part="" if reason else held_part(sample),
            by=grasp_evidence(sample),
        )

    async def _read(self, request: ReadGripper) -> GripperState:
        return self.state()

    def state(self) -> GripperState:
        """Return the measured state; what is held is judged by the active grasp command."""
        sample = self._port.sample()
        held = self.grip is not None and not check_grasp(sample, self.grip)
        return GripperState(
            time_s=sample.time_s,
            width_m=sample.width_m,
            force_n=sample.force_n,
            held=held,
            part=held_part(sample) if held else "",
            by=grasp_evidence(sample),
        )

    async def _move_to(self, width_m: float, speed_m_s: float, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        start = self._state()
        self.grip = None
        await self._carry_out(width_m, speed_m_s, _MOVE_FORCE_N, handle)
        sample = self._port.sample()
        if abs(sample.width_m - width_m) > _AT_WIDTH_M and not handle.cancel_requested:
            raise SkillFailed(
                f"the fingers stopped at {sample.width_m * 1e3:.1f} mm{_touching(sample)},"
                f" instead of {width_m * 1e3:.1f} mm",
                where=handle.address,
                hint="clear what is between or beside the fingers",
            )
        reason = f"fingers moved to {sample.width_m * 1e3:.1f} mm"
        return GraspResult(held=False, width_m=sample.width_m, force_n=sample.force_n, reason=reason, start=start)

    def _state(self) -> GripperSetting:
        """Return the present state as a setting that can be commanded again."""
        sample = self._port.sample()
        grip = self.grip if self.grip is not None and not check_grasp(sample, self.grip) else None
        width_m = min(max(0.0, sample.width_m), self._port.max_width_m)
        return GripperSetting(width_m=width_m, held=grip is not None, force_n=grip.force_n if grip is not None else 0.0)

    def _refuse_beyond(self, width_m: float, handle: ActiveGoal[GripperFeedback]) -> None:
        if width_m > self._port.max_width_m:
            raise GoalRejected(
                f"an opening of {width_m * 1e3:.1f} mm is not possible",
                where=handle.address,
                hint=f"this gripper opens to {self._port.max_width_m * 1e3:.1f} mm",
            )

    async def _carry_out(
        self, width_m: float, speed_m_s: float, force_n: float, handle: ActiveGoal[GripperFeedback]
    ) -> None:
        """Move the fingers and return when they are at rest, also when cancelled."""

        def report() -> None:
            handle.feedback(GripperFeedback(width_m=self._port.sample().width_m))

        await self._motion.carry_out(
            lambda: self._port.close_to(width_m=width_m, speed_m_s=speed_m_s, force_n=force_n), handle, report
        )


def _touching(sample: GripperSample) -> str:
    bodies = [body for body in dict.fromkeys(sample.contacts) if body]
    return f" against {' and '.join(bodies)}" if bodies else ""
