"""Brings the tool to a part or a place: free of collisions in front of it, then straight in."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from engine.cause_chain import cause_of
from engine.errors import SkillFailed
from engine.event import Cause
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
_TRIES = 8
"""With so many configurations of the arm at most a pose is tried."""
_TOLD_M = 0.001
"""From here on it is told how deep two things would be in one another."""
_SAME_RAD = 1.5
"""A joint that turns farther on the straight way is in another configuration at its other end."""


@dataclass(frozen=True, kw_only=True)
class Approach:
    """How an arm comes to a pose, and goes on: by which straight ways, how fast, how far from obstacles, how patient.

    `out_m` leads from the pose to where the arm comes from, `onward_m` to where it goes afterwards, in the world.
    `expected` tells which pairs are meant to touch at the pose; `kind` names the state in causes.
    """

    robot: str
    out_m: Vector3
    onward_m: Vector3
    speed: Speed
    line_speed_m_s: float
    margin_m: Margin
    patience_s: BlockedPathTimeout
    expected: Callable[[TouchingPair], bool]
    kind: str

    async def to(
        self, ctx: Context, poses: Sequence[Pose], *, before: Sequence[SequenceStep] = ()
    ) -> Pose | SequenceEnd:
        """Bring the tool to the first pose, in the world, that is reached and free; return which one.

        A configuration is chosen at the pose itself, and the same one in front of it: else the straight ways might
        end at a limit of a joint. `before` is gone through before the straight way.
        """
        ended = SequenceEnd("unreachable", None)
        for pose in poses:
            solutions = await self._solutions(ctx, pose)
            if isinstance(solutions, SequenceEnd):
                ended = solutions
                continue
            for joints in solutions:
                tried = await self._try(ctx, pose, joints, before)
                if tried is None:
                    return pose
                ended = tried
                if ended.outcome not in ("unreachable", "blocked"):
                    return ended
        return ended

    async def straight_to(self, ctx: Context, pose: Pose) -> SequenceEnd | None:
        """Go straight to a pose."""
        return await move_along_line(ctx, self.robot, pose, speed_m_s=self.line_speed_m_s, kind=self.kind)

    async def straight_out(self, ctx: Context, pose: Pose) -> SequenceEnd | None:
        """Go straight back to where the arm came to `pose` from."""
        return await self.straight_to(ctx, translate_pose(pose, self.out_m))

    async def _solutions(self, ctx: Context, pose: Pose) -> Sequence[tuple[float, ...]] | SequenceEnd:
        """Return configurations at a pose, soonest reached first."""
        try:
            return (await ctx.call(AllInverseKinematics(pose=pose), to=self.robot)).solutions[:_TRIES]
        except SkillFailed as error:
            return SequenceEnd("unreachable", cause_of(error))

    async def _try(
        self, ctx: Context, pose: Pose, joints: tuple[float, ...], before: Sequence[SequenceStep]
    ) -> SequenceEnd | None:
        """Bring the tool to a pose that it is to have with `joints`; None when it is there."""
        in_front = await self._in_front_of(ctx, pose, joints)
        if isinstance(in_front, SequenceEnd):
            return in_front
        move = MoveFree(
            robot=self.robot,
            joints=in_front,
            speed=self.speed,
            margin_m=self.margin_m,
            patience_s=self.patience_s,
        )
        return await run_steps(ctx, [SequenceStep(move, _ENDS), *before]) or await self.straight_to(ctx, pose)

    async def _in_front_of(
        self, ctx: Context, pose: Pose, joints: tuple[float, ...]
    ) -> tuple[float, ...] | SequenceEnd:
        report = await ctx.call(CheckCollision(robot=self.robot, joints=joints), to=CELL)
        pairs = [_in_words(pair) for pair in report.touching if not self.expected(pair)]
        if pairs:
            return SequenceEnd("blocked", Cause(message=f"there, {', '.join(pairs)} would touch", where=self.robot))
        in_front = await self._beside(ctx, translate_pose(pose, self.out_m), joints)
        onward = (
            await self._beside(ctx, translate_pose(pose, self.onward_m), joints)
            if self.onward_m != self.out_m
            else None
        )
        return onward if isinstance(onward, SequenceEnd) else in_front

    async def _beside(self, ctx: Context, pose: Pose, joints: tuple[float, ...]) -> tuple[float, ...] | SequenceEnd:
        """Return how the arm stands at the other end of a straight way, not otherwise than with `joints`."""
        try:
            found = (await ctx.call(InverseKinematics(pose=pose, seed=joints), to=self.robot)).joints
        except SkillFailed as error:
            return SequenceEnd("unreachable", cause_of(error))
        turned = max(abs(a - b) for a, b in zip(joints, found, strict=True))
        if turned <= _SAME_RAD:
            return found
        words = f"the straight way would turn a joint by {turned:.2f} rad"
        return SequenceEnd("unreachable", Cause(message=words, where=self.robot))


def _in_words(pair: TouchingPair) -> str:
    deep = f" ({pair.depth_m * 1000:.0f} mm deep)" if pair.depth_m >= _TOLD_M else ""
    return f"{pair.first} with {pair.second}{deep}"
