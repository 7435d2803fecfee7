"""Approach of the tool to a pose: a collision-free motion to the pre-approach pose, then a straight line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from engine.cause_chain import cause_of
from engine.errors import Cause, SkillFailed
from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import translate_pose
from engine.skills.motion import AllInverseKinematics, InverseKinematics, Speed
from engine.skills.planning import BlockedPathTimeout, Margin
from engine.skills.planning_scene import CheckCollision, TouchingPair
from engine.state import Context
from states.manipulation.approach_line import move_along_line
from states.manipulation.step_sequence import SequenceEnd, SequenceStep, run_steps
from states.motion.move_free import MoveFree
from states.scene.scene_parameter_types import CELL

_ENDS = {"no_way": "unreachable", "blocked": "blocked", "failed": "failed"}
OPENING_STEPS_M = (0.0, 0.015, 0.03, 0.06, 1.0)
"""Steps of the sweep of fingers that open or close; beyond the widest opening they stay there. Narrower than a
held part they are inside of it, where nothing else is."""

_MAX_CONFIGURATIONS = 8
"""Maximum number of arm configurations tried per pose."""
_REPORTED_DEPTH_M = 0.001
"""Minimum penetration depth that a message reports."""
_MAX_TURN_RAD = 1.5
"""A joint that turns farther along the straight line ends in another configuration."""


@dataclass(frozen=True, kw_only=True)
class Approach:
    """Parameters of an approach to a pose and of the retreat from it.

    `out_m` is the vector in the world from the pose to the pre-approach position, `onward_m` to the position of the
    arm afterwards. `expected` returns whether a pair may touch at the pose, `may_touch` names what the arm may touch
    on the lines, `openings_m` are those that the fingers pass through at the pose; `kind` is the state's name in
    causes.
    """

    robot: str
    out_m: Vector3
    onward_m: Vector3
    speed: Speed
    line_speed_m_s: float
    margin_m: Margin
    patience_s: BlockedPathTimeout
    expected: Callable[[TouchingPair], bool]
    may_touch: tuple[str, ...]
    openings_m: tuple[float, ...]
    kind: str

    async def to(
        self, ctx: Context, poses: Sequence[Pose], *, before: Sequence[SequenceStep] = ()
    ) -> Pose | SequenceEnd:
        """Move the tool to the first pose, in the world, that is reachable and collision-free; return that pose.

        The configuration is chosen at the pose itself and kept at the pre-approach pose: otherwise the straight line
        could end at a joint limit. The steps `before` run between the collision-free motion and the straight line.
        """
        ended = SequenceEnd("unreachable", None)
        for pose in poses:
            solutions = await self._solutions(ctx, pose)
            if isinstance(solutions, SequenceEnd):
                ended = solutions
                continue
            for joints in solutions:
                attempt = await self._attempt(ctx, pose, joints, before)
                if attempt is None:
                    return pose
                ended = attempt
                if ended.outcome not in ("unreachable", "blocked"):
                    return ended
        return ended

    async def straight_to(self, ctx: Context, pose: Pose) -> SequenceEnd | None:
        """Move on a straight line to a pose."""
        return await move_along_line(
            ctx, self.robot, pose, speed_m_s=self.line_speed_m_s, kind=self.kind, may_touch=self.may_touch
        )

    async def straight_out(self, ctx: Context, pose: Pose) -> SequenceEnd | None:
        """Move on a straight line from `pose` back to its pre-approach position."""
        return await self.straight_to(ctx, translate_pose(pose, self.out_m))

    async def _solutions(self, ctx: Context, pose: Pose) -> Sequence[tuple[float, ...]] | SequenceEnd:
        """Return arm configurations at a pose, nearest first."""
        try:
            return (await ctx.call(AllInverseKinematics(pose=pose), to=self.robot)).solutions[:_MAX_CONFIGURATIONS]
        except SkillFailed as error:
            return SequenceEnd("unreachable", cause_of(error))

    async def _attempt(
        self, ctx: Context, pose: Pose, joints: tuple[float, ...], before: Sequence[SequenceStep]
    ) -> SequenceEnd | None:
        """Move the tool to a pose in the configuration `joints`; None on success."""
        pre_approach = await self._pre_approach_joints(ctx, pose, joints)
        if isinstance(pre_approach, SequenceEnd):
            return pre_approach
        move = MoveFree(
            robot=self.robot,
            joints=pre_approach,
            speed=self.speed,
            margin_m=self.margin_m,
            patience_s=self.patience_s,
        )
        return await run_steps(ctx, [SequenceStep(move, _ENDS), *before]) or await self.straight_to(ctx, pose)

    async def _pre_approach_joints(
        self, ctx: Context, pose: Pose, joints: tuple[float, ...]
    ) -> tuple[float, ...] | SequenceEnd:
        check = CheckCollision(robot=self.robot, joints=joints, openings_m=self.openings_m)
        report = await ctx.call(check, to=CELL)
        pairs = [_describe_pair(pair) for pair in report.touching if not self.expected(pair)]
        if pairs:
            message = f"at the target, {', '.join(pairs)} would touch"
            return SequenceEnd("blocked", Cause(message=message, where=self.robot))
        pre_approach = await self._joints_at(ctx, translate_pose(pose, self.out_m), joints)
        onward = (
            await self._joints_at(ctx, translate_pose(pose, self.onward_m), joints)
            if self.onward_m != self.out_m
            else None
        )
        return onward if isinstance(onward, SequenceEnd) else pre_approach

    async def _joints_at(self, ctx: Context, pose: Pose, joints: tuple[float, ...]) -> tuple[float, ...] | SequenceEnd:
        """Return the joints at the other end of a straight line, in the same configuration as `joints`."""
        try:
            solution = (await ctx.call(InverseKinematics(pose=pose, seed=joints), to=self.robot)).joints
        except SkillFailed as error:
            return SequenceEnd("unreachable", cause_of(error))
        turned = max(abs(a - b) for a, b in zip(joints, solution, strict=True))
        if turned <= _MAX_TURN_RAD:
            return solution
        message = f"the straight line would turn a joint by {turned:.2f} rad"
        return SequenceEnd("unreachable", Cause(message=message, where=self.robot))


def _describe_pair(pair: TouchingPair) -> str:
    depth = f" ({pair.depth_m * 1000:.0f} mm deep)" if pair.depth_m >= _REPORTED_DEPTH_M else ""
    return f"{pair.first} with {pair.second}{depth}"
