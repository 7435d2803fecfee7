"""Builds the scene of a world from a cell document."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import msgspec

from engine.document import (
    CellDocument,
    DeviceAxis,
    Fixture,
    HexapodSpec,
    HingeAxis,
    LinearUnitSpec,
    Person,
    RobotSpec,
    UnknownBody,
)
from engine.errors import CellError
from engine.messages import Pose
from robots.model.meshes.convex_pieces import convex_pieces
from robots.model.registry import model_location
from robots.model.urdf.visual_mesh import file_visuals
from robots.scene.joined_bodies import drawn_bonds, part_poses
from robots.scene.sim_scene import (
    ArmPlacement,
    AxisBody,
    BeltBody,
    CarriageBody,
    FixtureBody,
    HexapodBody,
    MeshBody,
    PartBody,
    PersonBody,
    Rgba,
    SimScene,
)

Resolve = Callable[[str], Path]


def build_scene(document: CellDocument, *, seed: int | None = None, resolve: Resolve = Path) -> SimScene:
    """Return the scene of a cell; with a `seed`, parts are displaced by their jitter.

    The errors of the arms are drawn with the seed too, with 0 without one.

    Arms with another driver than `sim` are bodies only. `resolve` resolves the document's paths (`Cell.resolve`).

    Raises:
        CellError: a robot or gripper model is unknown, a mesh cannot be used, or the cell has no world.
        DocumentError: a model folder or a calibration file is invalid.
    """
    world = document.world
    if world is None:
        raise CellError("the cell has no world to simulate", where=document.cell, hint="add `world: {kind: mujoco}`")
    units = (device.linear_unit for device in document.devices.values())
    carriages = {unit.robot: unit.carriage for unit in units if unit is not None}
    return SimScene(
        step_s=world.step_s,
        gravity=world.gravity,
        realism=world.realism,
        seed=seed if seed is not None else 0,
        engine_silence_s=world.engine_silence_s,
        world_silence_s=world.world_silence_s,
        start_limit_s=world.start_limit_s,
        arms=tuple(
            msgspec.structs.replace(_arm(name, robot, resolve), on=carriages.get(name, ""))
            for name, robot in document.robots.items()
        ),
        fixtures=_fixtures(document, resolve),
        parts=tuple(_parts(document, seed)),
        bonds=drawn_bonds(document.bonds, seed=seed),
        people=tuple(_person(name, person) for name, person in document.people.items()),
        frames=document.fixed_frames,
        unknown_fixtures=tuple(
            _unknown_fixture(name, body) for name, body in document.unknown_bodies.items() if body.mass_kg is None
        ),
        unknown_parts=tuple(
            _unknown_part(name, body, mass_kg=body.mass_kg)
            for name, body in document.unknown_bodies.items()
            if body.mass_kg is not None
        ),
    )


def _fixtures(document: CellDocument, resolve: Resolve) -> tuple[FixtureBody, ...]:
    bodies = {name: _fixture(name, fixture, resolve) for name, fixture in document.fixtures.items()}
    for axis in (axis for device in document.devices.values() for axis in device.axes.values()):
        joint = _axis(axis)
        bodies[axis.body] = msgspec.structs.replace(bodies[axis.body], axis=joint, jaw_friction=axis.friction)
        for name in axis.against:
            bodies[name] = msgspec.structs.replace(bodies[name], jaw_friction=axis.friction)
    for belt in (belt for device in document.devices.values() for belt in device.belts.values()):
        surface = BeltBody(along=belt.along, speed_m_s=belt.speed_m_s, acceleration_m_s2=belt.acceleration_m_s2)
        bodies[belt.body] = msgspec.structs.replace(bodies[belt.body], belt=surface, jaw_friction=belt.friction)
    for braked in (device.braked for device in document.devices.values()):
        if braked is None:
            continue
        moved, *carried = braked.bodies
        if isinstance(braked, LinearUnitSpec):
            bodies[moved] = msgspec.structs.replace(bodies[moved], carriage=_carriage(braked))
        else:
            bodies[moved] = msgspec.structs.replace(bodies[moved], hexapod=_hexapod(braked))
        for name in carried:
            bodies[name] = msgspec.structs.replace(bodies[name], on=moved)
    return tuple(bodies.values())


def _carriage(unit: LinearUnitSpec) -> CarriageBody:
    return CarriageBody(
        along=unit.direction(Pose(xyz=(0.0, 0.0, 0.0))),
        travel_m=unit.travel_m,
        mass_kg=unit.mass_kg,
        friction_n=unit.friction_n,
        damping_ns_m=unit.damping_ns_m,
        holding_n=unit.holding_n,
    )


def _hexapod(hexapod: HexapodSpec) -> HexapodBody:
    return HexapodBody(
        base=hexapod.base,
        feet=hexapod.joints_of_base(),
        joints=hexapod.joints_of_platform(),
        length_m=hexapod.length_m,
        mass_kg=hexapod.mass_kg,
        friction_n=hexapod.friction_n,
        damping_ns_m=hexapod.damping_ns_m,
        holding_n=hexapod.holding_n,
    )


def _axis(axis: DeviceAxis) -> AxisBody:
    if isinstance(axis, HingeAxis):
        stroke, force, speed = axis.stroke_rad, axis.torque_nm, axis.speed_rad_s
    else:
        stroke, force, speed = axis.stroke_m, axis.force_n, axis.speed_m_s
    return AxisBody(
        hinge=isinstance(axis, HingeAxis),
        along=axis.along,
        stroke=stroke,
        force=force,
        speed=speed,
        mass_kg=axis.mass_kg,
        cuts=axis.cuts,
    )


def _mesh(name: str, fixture: Fixture, resolve: Resolve) -> MeshBody | None:
    if fixture.file is None:
        return None
    file, scale = resolve(fixture.file), fixture.scale
    try:
        return MeshBody(
            pieces=convex_pieces(file, scale=scale, decomposition=fixture.decomposition),
            looks=file_visuals(file, scale=scale, colour=_rgba(fixture.color)),
        )
    except CellError as error:
        raise CellError(f"fixture `{name}`: {error.message}", where=error.where, hint=error.hint) from error


def _fixture(name: str, fixture: Fixture, resolve: Resolve) -> FixtureBody:
    body = FixtureBody(
        name=name,
        shape=fixture.shape,
        size_m=fixture.size_m,
        wall_m=fixture.wall_m,
        pose=fixture.at.pose(),
        mesh=_mesh(name, fixture, resolve),
        rgba=_rgba(fixture.color),
    )
    spring = fixture.spring
    if spring is None:
        return body
    return msgspec.structs.replace(
        body,
        spring_n_m=spring.stiffness_n_m,
        spring_ns_m=spring.damping_ns_m,
        sprung_kg=spring.mass_kg,
        skin_friction=spring.friction,
    )


def driven_arm(name: str, robot: RobotSpec, resolve: Resolve) -> ArmPlacement:
    """Return the placement of an arm with a driver.

    Raises:
        CellError: its model is unknown.
        DocumentError: a model folder or a calibration file is invalid.
    """
    return _arm(name, robot, resolve)


def _arm(name: str, robot: RobotSpec, resolve: Resolve) -> ArmPlacement:
    placement = ArmPlacement(
        name=name,
        model=model_location(robot.model, resolve),
        base=robot.base.pose(),
        gripper=model_location(robot.gripper.model, resolve) if robot.gripper is not None else None,
        calibration=str(resolve(robot.calibration)) if robot.calibration is not None else None,
        coupled_joints=robot.coupled_joints,
        driven_tool=robot.gripper is not None and (bool(robot.gripper.driver_kind) or not robot.simulated),
        driven=not robot.simulated,
        tool_changer=robot.tool_changer,
    )
    try:
        placement.robot()
    except CellError as error:
        raise CellError(error.message, where=f"robot {name}", hint=error.hint) from error
    return placement


def _parts(document: CellDocument, seed: int | None) -> list[PartBody]:
    bodies: list[PartBody] = []
    poses = part_poses(document.parts, document.bonds, seed=seed)
    for name, part in document.parts.items():
        bodies.append(
            PartBody(
                name=name,
                shape=part.shape,
                size_m=part.size_m,
                mass_kg=part.mass_kg,
                magnetic=part.magnetic,
                friction=part.friction,
                pose=poses[name],
                rgba=_rgba(part.color),
                tool=part.tool,
            )
        )
    return bodies


def _unknown_fixture(name: str, body: UnknownBody) -> FixtureBody:
    return FixtureBody(name=name, shape=body.shape, size_m=body.size_m, pose=body.at.pose(), rgba=_rgba(body.color))


def _unknown_part(name: str, body: UnknownBody, *, mass_kg: float) -> PartBody:
    return PartBody(
        name=name,
        shape=body.shape,
        size_m=body.size_m,
        mass_kg=mass_kg,
        pose=body.at.pose(),
        rgba=_rgba(body.color),
    )


def _person(name: str, person: Person) -> PersonBody:
    return PersonBody(
        name=name,
        shoulder=person.shoulder,
        hand_rests=person.hand_rests,
        upper_arm_m=person.upper_arm_m,
        forearm_m=person.forearm_m,
        radius_m=person.radius_m,
        rgba=_rgba(person.color),
    )


def _rgba(color: str) -> Rgba:
    red, green, blue = (int(color[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return (red, green, blue, 1.0)
