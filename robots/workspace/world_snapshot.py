"""Measures a simulated world at one instant, from its latest snapshot."""

from __future__ import annotations

from engine.messages.tool_hold import ToolHold
from robots.model.transform import RigidTransform
from robots.scene.sim_scene import SimScene
from robots.sim.grip.tool_reading import state_publisher
from robots.sim.loop.bond_reading import joined_bodies
from robots.sim.loop.snapshot import ArmSummary, SimSnapshot
from robots.sim.world.sim_world import SimWorld
from robots.workspace.measured_poses import MeasuredArm, MeasuredPoses
from robots.workspace.tool_joint_estimator import ToolJointEstimator


class WorldPoseReader:
    """Callable that measures the world, which must be open."""

    def __init__(self, world: SimWorld, scene: SimScene) -> None:
        self._world = world
        self._arms = {arm.name: ToolJointEstimator(arm.robot()) for arm in scene.arms}

    def __call__(self) -> MeasuredPoses:
        """Return the measured arms, tools and parts."""
        snapshot, summary = self._world.measured(), self._world.host.summary
        tools = {arm.name: arm for arm in summary.arms}

        def frame(name: str) -> RigidTransform:
            return RigidTransform.of(*snapshot.frame(name))

        def link(arm: str, name: str) -> RigidTransform:
            return frame(f"{arm}/{name}")

        arms = {
            name: MeasuredArm(
                joints_rad=tuple(snapshot.arm(name).position_rad.tolist()),
                tool_joints=tool.read(lambda one, arm=name: link(arm, one)),
                holds=_held_part(snapshot, tools[name], parts=summary.parts),
            )
            for name, tool in self._arms.items()
        }
        scene = self._world.modules.scene
        return MeasuredPoses(
            arms=arms,
            parts={part.name: frame(part.name) for part in scene.parts},
            link=link,
            joined=joined_bodies(scene.bonds, snapshot.bonds()) if scene.bonds else {},
        )


def _held_part(snapshot: SimSnapshot, arm: ArmSummary, *, parts: tuple[str, ...]) -> str:
    """Return the part that the tool of an arm holds, by contact, or the tool that its tool changer has.

    Empty if none, or if its name is not measured.
    """
    following = snapshot.held_part(arm.name)
    if following or arm.tool is None:
        return following
    state = state_publisher(arm.tool.kind).state(snapshot.tool(arm.name), arm.tool, parts=parts)
    return state.part if isinstance(state, ToolHold) and state.held and state.part in parts else ""
