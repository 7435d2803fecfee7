"""From a cell document to the scene that a world is built from."""

from __future__ import annotations

from engine.document.cell import CellDocument, RobotEntry
from engine.errors import CellError
from robots.model.registry import model_by_name
from robots.sim.jitter import jittered
from robots.sim.scene import ArmPlacement, FixtureBody, PartBody, Rgba, Scene


def scene_of(document: CellDocument, *, seed: int | None = None) -> Scene:
    """Return the scene of a cell; with a `seed`, parts lie off by their jitter.

    Robots with another driver than `sim` are left out.

    Raises:
        CellError: a robot or gripper model is unknown, or the cell has no world.
    """
    world = document.world
    if world is None:
        raise CellError("the cell has no world to simulate", where=document.cell, hint="add `world: {kind: mujoco}`")
    return Scene(
        step_s=world.step_s,
        gravity=world.gravity,
        arms=tuple(_arm(name, robot) for name, robot in document.robots.items() if robot.simulated),
        fixtures=tuple(
            FixtureBody(
                name=name,
                shape=fixture.shape,
                size_m=fixture.size_m,
                wall_m=fixture.wall_m,
                pose=fixture.at.pose(),
                rgba=_rgba(fixture.color),
            )
            for name, fixture in document.fixtures.items()
        ),
        parts=tuple(_parts(document, seed)),
    )


def _arm(name: str, robot: RobotEntry) -> ArmPlacement:
    model = model_by_name(robot.model)
    wanted = robot.gripper.model if robot.gripper is not None else None
    own = model.gripper.name if model.gripper is not None else None
    if wanted != own:
        hint = f"write `gripper: {{model: {own}}}`" if own else "remove `gripper`"
        raise CellError(
            f"the robot model {model.name} comes with the gripper {own}, not {wanted}", where=name, hint=hint
        )
    return ArmPlacement(name=name, model=robot.model, base=robot.base.pose())


def _parts(document: CellDocument, seed: int | None) -> list[PartBody]:
    bodies: list[PartBody] = []
    for name, part in document.parts.items():
        pose = part.at.pose()
        if seed is not None:
            pose = jittered(pose, name=name, seed=seed, xy_m=part.jitter.xy_m, yaw_rad=part.jitter.yaw_rad)
        bodies.append(
            PartBody(
                name=name,
                shape=part.shape,
                size_m=part.size_m,
                mass_kg=part.mass_kg,
                pose=pose,
                rgba=_rgba(part.color),
            )
        )
    return bodies


def _rgba(color: str) -> Rgba:
    red, green, blue = (int(color[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return (red, green, blue, 1.0)
