"""manipulation.PickPart: picks and lifts a part, from any configuration of the arm."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.errors import Cause
from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import angle_between_rad, compose_poses, translate_pose
from engine.skills.arm_control import Mass
from engine.skills.gripper import Width
from engine.skills.motion import CartLinTask, ForwardKinematics, Speed
from engine.skills.planning import BlockedPathTimeout, Margin, MoveFree
from engine.skills.planning_scene import TouchingPair
from engine.state import Context, Outcome, Skills, State
from states.frames import frame_in_world, part_in_world
from states.gripper.grasp import Force
from states.hand.hand_parameter_types import Percent
from states.manipulation.approach import OPENING_STEPS_M, Approach
from states.manipulation.approach_line import ApproachDirection, LineLength, LineSpeed, retreat_vector
from states.manipulation.step_sequence import SequenceEnd, SequenceStep, run_steps
from states.manipulation.tool_states import (
    ToolName,
    check_held_state,
    hold_state,
    release_state,
    require_tool,
    tool_resource,
)
from states.motion.motion_target import NO_OFFSET, PoseTarget, RobotName, resolve_pose
from states.motion.set_load import SetLoad
from states.scene.attach import Attach
from states.scene.detach import Detach
from states.scene.scene_parameter_types import PartName

PART = "part"
"""The frame of the part, in `grasp`."""


class GraspTarget(PoseTarget, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A pose of the tool centre point in the frame `part`, or in any other frame of the cell."""

    frame: Annotated[str, Meta(extra_json_schema={"cell_name": "frame", "or": [PART]})] = "world"


FROM_ABOVE = GraspTarget(xyz=(0.0, 0.0, 0.0), xyzw=(1.0, 0.0, 0.0, 0.0), frame=PART)
_FAILED = {"failed": "failed"}
_NOT_LIFTED = ("missed", "unreachable", "blocked")
"""Outcomes of closing and lifting after which the part is still in place, or lost."""


class PickPart(State, frozen=True, kw_only=True):
    """Open the tool, move collision-free to the pre-approach pose, straight to the part, close, lift, check the grasp.

    The state reads the latest measured pose of the part. Motions with the held part are planned including it.
    `missed` when the tool does not hold the part after closing or lifting, or when there is no such part;
    `unreachable` when the arm cannot reach the part or lift it; `blocked` when the planning scene blocks the arm or
    the lifted part. These outcomes write the `reason`; a tool that has closed opens again, and the arm retreats to the
    pre-approach pose.
    """

    state_name: ClassVar[str] = "manipulation.PickPart"
    skills: ClassVar[Skills] = (MoveFree, CartLinTask)
    outcomes: ClassVar[tuple[str, ...]] = ("picked", "missed", "unreachable", "blocked", "failed")
    success: ClassVar[tuple[str, ...]] = ("picked",)
    outputs: ClassVar[Mapping[str, Any]] = {"reason": str}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"picked": ("reason",)}

    robot: RobotName
    part: PartName
    tool: ToolName = "gripper"
    grasp: Annotated[
        GraspTarget,
        Meta(description="Pose of the tool centre point at the part: `{xyz, xyzw, frame}`, frame `part` or another"),
    ] = FROM_ABOVE
    turns: Annotated[
        int, Meta(ge=1, le=8, description="Number of equivalent grasp rotations about the tool's z axis")
    ] = 1
    approach: ApproachDirection = None
    approach_m: LineLength = 0.1
    lift_m: Annotated[LineLength, Meta(description="Lift distance along the world z axis")] = 0.1
    width_m: Annotated[Width | None, Meta(description="Width of the part between the fingers of a gripper")] = None
    force_n: Force = 20.0
    percent: Annotated[Percent, Meta(description="Target closing of a hand, 0 open to 100 closed")] = 80.0
    mass_kg: Annotated[
        Mass, Meta(description="Mass of the part, set as the arm's load; 0 leaves the load unchanged")
    ] = 0.0
    speed: Speed = 0.3
    line_speed_m_s: LineSpeed = 0.1
    margin_m: Margin = 0.0
    patience_s: BlockedPathTimeout = 60.0

    def __post_init__(self) -> None:
        require_tool(self.tool)
        if self.tool == "gripper" and self.width_m is None:
            raise ValueError("a gripper needs `width_m`, the width of the part between its fingers")
        if self.approach is not None and not any(self.approach):
            raise ValueError("`approach` must not be a zero vector")

    def resources(self) -> tuple[str, ...]:
        """Return the arm and its tool."""
        return (self.robot, tool_resource(self.robot, self.tool))

    async def run(self, ctx: Context) -> Outcome:
        """Run the steps of the pick."""
        ended = await self._pick(ctx)
        if ended is None:
            return Outcome("picked")
        return ended.under(f"{self.robot} did not pick part {self.part}", where=ctx.path, kind=self.state_name)

    async def _pick(self, ctx: Context) -> SequenceEnd | None:
        candidates = await self._grasps(ctx)
        if isinstance(candidates, Cause):
            return SequenceEnd("missed", candidates)
        frame, grasps = candidates
        approach = self._approach(retreat_vector(grasps[0], frame, self.approach, self.approach_m))
        if ended := await run_steps(ctx, [SequenceStep(release_state(self.robot, self.tool, ""), _FAILED)]):
            return ended
        grasp = await approach.to(ctx, grasps)
        if isinstance(grasp, SequenceEnd):
            return grasp
        ended = await self._close(ctx) or await self._lift(ctx, approach, grasp)
        if ended is not None and ended.outcome in _NOT_LIFTED:
            return await self._release(ctx) or await approach.straight_out(ctx, grasp) or ended
        return ended

    async def _grasps(self, ctx: Context) -> tuple[Pose, list[Pose]] | Cause:
        """Return the frame of `grasp`, and the candidate poses in the world, smallest rotation from the tool first."""
        given = await resolve_pose(ctx, self.grasp, NO_OFFSET)
        of_part = given.frame in (PART, self.part)
        frame = await part_in_world(ctx, self.part) if of_part else await frame_in_world(ctx, given.frame)
        if isinstance(frame, Cause):
            return frame
        grasp = compose_poses(frame, given)
        if self.turns == 1:
            return frame, [grasp]
        tool = await ctx.call(ForwardKinematics(), to=self.robot)
        rotated = [compose_poses(grasp, _rotation(2 * math.pi * turn / self.turns)) for turn in range(self.turns)]
        return frame, sorted(rotated, key=lambda pose: round(angle_between_rad(pose.xyzw, tool.xyzw), 6))

    def _approach(self, out_m: Vector3) -> Approach:
        return Approach(
            robot=self.robot,
            out_m=out_m,
            onward_m=(0.0, 0.0, self.lift_m),
            speed=self.speed,
            line_speed_m_s=self.line_speed_m_s,
            margin_m=self.margin_m,
            patience_s=self.patience_s,
            expected=self._may_touch,
            may_touch=(self.part,),
            openings_m=self._openings_m(),
            kind=self.state_name,
        )

    def _openings_m(self) -> tuple[float, ...]:
        """Return openings of the fingers from that of the part to the widest; none of a tool without an opening."""
        if self.tool != "gripper" or self.width_m is None:
            return ()
        return tuple(self.width_m + step_m for step_m in OPENING_STEPS_M)

    def _may_touch(self, pair: TouchingPair) -> bool:
        return self.part in (pair.first, pair.second)

    async def _close(self, ctx: Context) -> SequenceEnd | None:
        steps = [
            SequenceStep(self._closing(), {"missed": "missed", "failed": "failed"}),
            SequenceStep(Attach(part=self.part, robot=self.robot), _FAILED),
        ]
        load = SequenceStep(SetLoad(robot=self.robot, mass_kg=self.mass_kg), _FAILED)
        return await run_steps(ctx, [*steps, load] if self.mass_kg else steps)

    def _closing(self) -> State:
        settings = {"width_m": self.width_m or 0.0, "force_n": self.force_n, "percent": self.percent}
        return hold_state(self.robot, self.tool, self.part, settings)

    async def _lift(self, ctx: Context, approach: Approach, grasp: Pose) -> SequenceEnd | None:
        held = SequenceStep(check_held_state(self.robot, self.tool, self.part), {"lost": "missed"})
        lifted = translate_pose(grasp, (0.0, 0.0, self.lift_m))
        return await approach.straight_to(ctx, lifted) or await run_steps(ctx, [held])

    async def _release(self, ctx: Context) -> SequenceEnd | None:
        steps = [
            SequenceStep(release_state(self.robot, self.tool, ""), _FAILED),
            SequenceStep(Detach(part=self.part), _FAILED),
        ]
        unload = SequenceStep(SetLoad(robot=self.robot, mass_kg=0.0), _FAILED)
        return await run_steps(ctx, [*steps, unload] if self.mass_kg else steps)


def _rotation(angle_rad: float) -> Pose:
    return Pose(xyz=(0.0, 0.0, 0.0), xyzw=(0.0, 0.0, math.sin(angle_rad / 2), math.cos(angle_rad / 2)))
