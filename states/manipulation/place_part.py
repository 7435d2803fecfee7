"""manipulation.PlacePart: places the part that an arm holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from msgspec import Meta

from engine.errors import Cause
from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import compose_poses, invert_pose
from engine.skills.motion import CartLinTask, ForwardKinematics, Speed
from engine.skills.planning import BlockedPathTimeout, Margin, MoveFree
from engine.skills.planning_scene import CONTACT_M, TouchingPair
from engine.state import Context, Outcome, Skills, State
from states.frames import frame_in_world, part_in_world
from states.manipulation.approach import OPENING_STEPS_M, Approach
from states.manipulation.approach_line import ApproachDirection, LineLength, LineSpeed, retreat_vector
from states.manipulation.step_sequence import SequenceEnd, SequenceStep, run_steps
from states.manipulation.tool_states import ToolName, check_held_state, release_state, require_tool, tool_resource
from states.motion.motion_target import NO_OFFSET, RobotName, ShownPoseTarget, resolve_pose
from states.motion.set_load import SetLoad
from states.scene.detach import Detach
from states.scene.scene_parameter_types import PartName

_FAILED = {"failed": "failed"}


class PlacePart(State, frozen=True, kw_only=True):
    """Move collision-free to the pre-approach pose and straight to the target, open the tool, and retreat straight.

    With `target_of: part` the part itself ends at the target, however the tool holds it. Over the last 5 mm of the
    line the part may touch what it is placed on; a deeper or earlier contact is `blocked` in advance, and the
    `reason` names both bodies. `missed` when the part is lost on the path; `unreachable` and `blocked` as in
    `manipulation.PickPart`, with the part still held. Afterwards the load of the arm is 0 kg.
    """

    state_name: ClassVar[str] = "manipulation.PlacePart"
    skills: ClassVar[Skills] = (MoveFree, CartLinTask)
    outcomes: ClassVar[tuple[str, ...]] = ("placed", "missed", "unreachable", "blocked", "failed")
    success: ClassVar[tuple[str, ...]] = ("placed",)
    outputs: ClassVar[Mapping[str, Any]] = {"reason": str}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"placed": ("reason",)}

    robot: RobotName
    part: PartName
    target: Annotated[ShownPoseTarget, Meta(description="Target pose: `{xyz, xyzw, frame}`, or `{entry: name}`")]
    target_of: Annotated[
        Literal["tool", "part"], Meta(description="What ends at `target`: the tool centre point or the part")
    ] = "tool"
    tool: ToolName = "gripper"
    approach: ApproachDirection = None
    approach_m: LineLength = 0.1
    speed: Speed = 0.3
    line_speed_m_s: LineSpeed = 0.1
    margin_m: Margin = 0.0
    patience_s: BlockedPathTimeout = 60.0

    def __post_init__(self) -> None:
        require_tool(self.tool)
        if self.approach is not None and not any(self.approach):
            raise ValueError("`approach` must not be a zero vector")

    def resources(self) -> tuple[str, ...]:
        """Return the arm and its tool."""
        return (self.robot, tool_resource(self.robot, self.tool))

    async def run(self, ctx: Context) -> Outcome:
        """Run the steps of the placement."""
        ended = await self._place(ctx)
        if ended is None:
            return Outcome("placed")
        return ended.under(f"{self.robot} did not place part {self.part}", where=ctx.path, kind=self.state_name)

    async def _place(self, ctx: Context) -> SequenceEnd | None:
        held = [SequenceStep(check_held_state(self.robot, self.tool, self.part), {"lost": "missed"})]
        if ended := await run_steps(ctx, held):
            return ended
        target = await self._tool_target(ctx)
        if isinstance(target, Cause):
            return SequenceEnd("missed", target)
        frame, tool_pose = target
        approach = self._approach(retreat_vector(tool_pose, frame, self.approach, self.approach_m))
        reached = await approach.to(ctx, [tool_pose], before=held)
        if isinstance(reached, SequenceEnd):
            return reached
        return await run_steps(ctx, self._release_steps()) or await approach.straight_out(ctx, tool_pose)

    async def _tool_target(self, ctx: Context) -> tuple[Pose, Pose] | Cause:
        """Return the frame of the target, and the pose of the tool at the target, both in the world."""
        given = await resolve_pose(ctx, self.target, NO_OFFSET)
        frame = await frame_in_world(ctx, given.frame)
        target = compose_poses(frame, given)
        if self.target_of == "tool":
            return frame, target
        part = await part_in_world(ctx, self.part)
        if isinstance(part, Cause):
            return part
        tool = await ctx.call(ForwardKinematics(), to=self.robot)
        return frame, compose_poses(target, compose_poses(invert_pose(part), tool))

    def _approach(self, out_m: Vector3) -> Approach:
        return Approach(
            robot=self.robot,
            out_m=out_m,
            onward_m=out_m,
            speed=self.speed,
            line_speed_m_s=self.line_speed_m_s,
            margin_m=self.margin_m,
            patience_s=self.patience_s,
            expected=self._is_support_contact,
            may_touch=(self.part,),
            openings_m=OPENING_STEPS_M if self.tool == "gripper" else (),
            kind=self.state_name,
        )

    def _is_support_contact(self, pair: TouchingPair) -> bool:
        """Return whether a pair is the part and its support: no link of an arm, and at most `CONTACT_M` deep."""
        other = pair.second if pair.first == self.part else pair.first
        return self.part in (pair.first, pair.second) and "/" not in other and pair.depth_m <= CONTACT_M

    def _release_steps(self) -> list[SequenceStep]:
        return [
            SequenceStep(release_state(self.robot, self.tool, self.part), _FAILED),
            SequenceStep(Detach(part=self.part), _FAILED),
            SequenceStep(SetLoad(robot=self.robot, mass_kg=0.0), _FAILED),
        ]
