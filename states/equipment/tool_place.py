"""The place of a tool in its hanger: who is there, and the straight line to it and out of it."""

from __future__ import annotations

import math

from engine.errors import Cause
from engine.messages import PartPoses, Pose, Vector3
from engine.messages.pose_algebra import compose_poses
from engine.skills.motion import ForwardKinematics, Speed
from engine.skills.planning import BlockedPathTimeout, Margin
from engine.skills.planning_scene import CONTACT_M, TouchingPair
from engine.skills.tool_changer import ReadToolChanger, ToolDescription
from engine.state import Context
from states.frames import PARTS_TOPIC
from states.manipulation.approach import Approach
from states.manipulation.step_sequence import SequenceEnd

_AT_PLACE_M = 0.01
"""A tool whose plate is farther from its place is not in its place."""
_NEIGHBOUR_M = 0.03
"""A part whose centre is nearer to the place of a tool is in its place."""
_OUT_SHARE = 0.9
"""Share of the way out from which on an arm is out."""


async def who_is_at(ctx: Context, description: ToolDescription, tool: str) -> tuple[bool, str]:
    """Return whether a tool is measured in its place, and which other part is there; empty for none."""
    place = compose_poses(description.docked, description.tool.plate).xyz
    parts = await ctx.latest(PARTS_TOPIC, PartPoses)
    away_m = {name: math.dist(pose.xyz, place) for name, pose in parts.poses.items()}
    others = (name for name, distance_m in away_m.items() if name != tool and distance_m <= _NEIGHBOUR_M)
    return away_m.get(tool, math.inf) <= _AT_PLACE_M, next(others, "")


def tool_approach(
    robot: str,
    tool: str,
    *,
    out_m: Vector3,
    speed: Speed,
    line_speed_m_s: float,
    margin_m: Margin,
    patience_s: BlockedPathTimeout,
    kind: str,
) -> Approach:
    """Return the approach to the place of a tool, which is left in the same direction.

    The tool may touch the face, and what it hangs in, at most `CONTACT_M` deep.
    """

    def expected(pair: TouchingPair) -> bool:
        return tool in (pair.first, pair.second) and pair.depth_m <= CONTACT_M

    return Approach(
        robot=robot,
        out_m=out_m,
        onward_m=out_m,
        speed=speed,
        line_speed_m_s=line_speed_m_s,
        margin_m=margin_m,
        patience_s=patience_s,
        expected=expected,
        may_touch=(tool,),
        openings_m=(),
        kind=kind,
    )


async def straight_out(ctx: Context, approach: Approach, docked: Pose) -> SequenceEnd | None:
    """Move the arm straight out of the place; not at all where it is out already.

    `docked` is where its tool centre point is in the place, in the world.
    """
    now = await ctx.call(ForwardKinematics(), to=approach.robot)
    if math.dist(now.xyz, docked.xyz) >= _OUT_SHARE * math.hypot(*approach.out_m):
        return None
    return await approach.straight_out(ctx, docked)


async def require_on(ctx: Context, robot: str, tool: str) -> SequenceEnd | None:
    """Return None where a tool is locked to the arm, else how a sequence ends."""
    state = await ctx.call(ReadToolChanger(), to=robot)
    if state.tool == tool:
        return None
    what = state.problem or (f"{robot} has {state.tool}" if state.tool else f"{robot} has no tool")
    return SequenceEnd("missing", Cause(message=what, where=f"{robot}/tool_changer"))


def docked_tcp(description: ToolDescription, tcp: str) -> Pose:
    """Return where a tool centre point is while the tool is docked in its place, in the world."""
    return compose_poses(description.docked, description.tool.tcps[tcp]) if tcp else description.docked
