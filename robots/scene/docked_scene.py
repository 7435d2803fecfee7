"""The scene of a cell with its modules: all that can be in its world, and what of it is there now."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from msgspec.structs import replace

from engine.document import Cell, CellDocument, docks_at_start
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses, invert_pose
from robots.scene.sim_scene import ArmPlacement, ModuleBodies, SimScene


def with_modules(scene: SimScene, cell: Cell) -> SimScene:
    """Return the scene of a cell, built from its document, with its modules."""
    frames, docks = cell.document.fixed_frames, docks_at_start(cell)
    bodies = tuple(
        ModuleBodies(
            name=name,
            at=frames[name],
            plugged=name in docks,
            fixtures=tuple(each.name for each in scene.fixtures if each.name.startswith(f"{name}/")),
            parts=tuple(each.name for each in scene.parts if each.name.startswith(f"{name}/")),
        )
        for name in cell.document.modules
    )
    return replace(scene, modules=bodies)


def docked_scene(whole: SimScene, document: CellDocument, *, away: Collection[str]) -> SimScene:
    """Return what is in the world of a cell.

    Args:
        whole: The scene with everything.
        document: The cell with only the modules that are plugged.
        away: The parts that are on modules which are not plugged.
    """
    return replace(
        whole,
        fixtures=tuple(
            replace(body, pose=document.fixtures[body.name].at.pose())
            for body in whole.fixtures
            if body.name in document.fixtures
        ),
        parts=tuple(part for part in whole.parts if part.name not in away),
        frames=document.fixed_frames,
    )


def with_moved_fixtures(
    scene: SimScene, poses: Mapping[str, Pose], *, whole: SimScene, loose: Collection[str] = ()
) -> SimScene:
    """Return a scene with fixtures where they are now, and the bases of the arms that stand on them.

    Args:
        scene: What is in the world.
        poses: The poses in the world of the fixtures that have moved.
        whole: The scene with everything, as it was built.
        loose: The carriages that are released.
    """
    fixtures = tuple(replace(one, pose=poses.get(one.name, one.pose)) for one in scene.fixtures)
    home = {one.name: one.pose for one in whole.fixtures if one.carriage is not None}
    first = {arm.name: arm.base for arm in whole.arms}

    def moved(arm: ArmPlacement) -> ArmPlacement:
        if arm.on not in poses:
            return arm
        stands = compose_poses(invert_pose(home[arm.on]), first[arm.name])
        return replace(arm, base=compose_poses(poses[arm.on], stands), loose=arm.on in loose)

    return replace(scene, fixtures=fixtures, arms=tuple(moved(arm) for arm in scene.arms))
