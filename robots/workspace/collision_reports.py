"""Reports the contacts of an arm in a scene, with the fingers where they are or at given openings."""

from __future__ import annotations

from engine.messages.sensing import OccupancyGrid
from engine.skills.planning_scene import CheckCollision, CollisionReport, TouchingPair
from robots.planning.request import CollisionRequest
from robots.planning.scene.planning_scene import PlanningScene
from robots.workspace.planning_services import PlanningServices


async def collision_report(
    planners: PlanningServices, scene: PlanningScene, request: CheckCollision, *, occupancy: OccupancyGrid | None
) -> CollisionReport:
    """Return the contacts and the clearance of an arm, over all openings of its fingers that are asked for.

    Raises:
        CellError: the scene has no such arm or is invalid, or the joints do not fit the arm.
        RobotError: the planning process has ended.
    """
    arm = scene.arm(request.robot)
    joints = request.joints or arm.joints_rad
    reports = [
        await planners.look(CollisionRequest(scene=one, arm=arm.name, joints_rad=joints, occupancy=occupancy))
        for one in _with_fingers(scene, request)
    ]
    deepest: dict[tuple[str, str], TouchingPair] = {}
    for pair in sorted((pair for report in reports for pair in report.touching), key=lambda pair: -pair.depth_m):
        deepest.setdefault((pair.first, pair.second), pair)
    nearest = min(reports, key=lambda report: report.distance_m)
    return CollisionReport(touching=tuple(deepest.values()), distance_m=nearest.distance_m, nearest=nearest.nearest)


def _with_fingers(scene: PlanningScene, request: CheckCollision) -> tuple[PlanningScene, ...]:
    """Return the scene with the fingers at each opening; as it is for a tool without fingers."""
    arm = scene.arm(request.robot)
    tool = arm.placement.robot().tool
    if tool is None or not request.openings_m:
        return (scene,)
    measured = dict(arm.tool_joints)
    return tuple(
        scene.with_joints(arm.name, arm.joints_rad, tool_joints=measured | tool.mechanism.joints_at(opening_m))
        for opening_m in request.openings_m
    )
