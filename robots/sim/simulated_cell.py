"""The world of a cell document with skill servers on its arms and grippers: the entry point `mujoco`."""

from __future__ import annotations

from engine.bus import SkillBus
from engine.clock import Clock
from engine.document.cell import Cell
from robots.arm.arm_server import ArmServer
from robots.gripper.gripper_server import GripperServer
from robots.model.registry import model_by_name
from robots.sim.cell_scene import scene_of
from robots.sim.scene import ArmPlacement
from robots.sim.world import SimRobot, SimWorld
from robots.sim.world import new_world as new_sim_world


def new_world(cell: Cell, *, bus: SkillBus, virtual: bool, seed: int | None) -> SimWorld:
    """Return the simulated world of a cell, not yet open; its robots answer the motion and gripper skills.

    Raises:
        CellError: a model is unknown, or a size or gripper does not fit.
    """
    scene = scene_of(cell.document, seed=seed)

    def make_robots(world: SimWorld) -> tuple[SimRobot, ...]:
        return tuple(_arm(world, placement, bus.clock) for placement in scene.arms)

    return new_sim_world(scene, virtual=virtual, make_robots=make_robots)


def _arm(world: SimWorld, placement: ArmPlacement, clock: Clock) -> ArmServer:
    model = model_by_name(placement.model)
    gripper = None
    if model.gripper is not None:
        gripper = GripperServer(name=f"{placement.name}/gripper", port=world.gripper(placement.name))
    return ArmServer(
        name=placement.name,
        model=model,
        base=placement.base,
        port=world.arm(placement.name),
        clock=clock,
        gripper=gripper,
    )
