"""Looks at a simulated world: everything in it at one instant, from its newest snapshot."""

from __future__ import annotations

from robots.model.rigid import Rigid
from robots.sim.scene import Scene
from robots.sim.world import SimWorld
from robots.workspace.seen import ArmSeen, Seen
from robots.workspace.tool_angles import ToolAngles


class WorldLook:
    """Call it to look; the world is open."""

    def __init__(self, world: SimWorld, scene: Scene) -> None:
        self._world = world
        self._arms = {arm.name: ToolAngles(arm.robot()) for arm in scene.arms}

    def __call__(self) -> Seen:
        """Return where arms, tools and parts are."""
        snapshot, summary = self._world.measured(), self._world.host.summary
        xyz, xyzw = snapshot.frames()
        row = {name: index for index, name in enumerate(summary.frames)}

        def frame(name: str) -> Rigid:
            return Rigid.of(xyz[row[name]], xyzw[row[name]])

        def link(arm: str, name: str) -> Rigid:
            return frame(f"{arm}/{name}")

        arms = {
            name: ArmSeen(
                joints_rad=tuple(snapshot.arm(name).position_rad.tolist()),
                tool_joints=tool.read(lambda one, arm=name: link(arm, one)),
            )
            for name, tool in self._arms.items()
        }
        return Seen(arms=arms, parts={name: frame(name) for name in summary.parts}, link=link)
