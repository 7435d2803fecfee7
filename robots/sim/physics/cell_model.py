"""A scene as a compiled MuJoCo model, and the array indices of each arm, finger and part."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.errors import CellError
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses, invert_pose
from robots.model.meshes.convex_pieces import Piece
from robots.model.robot_model import RobotModel
from robots.scene.sim_scene import ArmPlacement, FixtureBody, PartBody, SimScene
from robots.sim.physics.arm_spec import arm_spec
from robots.sim.physics.bond_constraint import add_bonds
from robots.sim.physics.device_axis import add_axis, add_belt, add_jaw, add_slide
from robots.sim.physics.hexapod_legs import add_legs, place_on
from robots.sim.physics.person_spec import PersonIndices, add_person, body_names, let_people_touch, person_indices
from robots.sim.physics.physics import mujoco
from robots.sim.physics.plant_errors import PlantErrors
from robots.sim.physics.tool_body import PAD_SOLIMP, PAD_SOLREF, ToolIndices, tool_body
from robots.sim.physics.tool_coupling import add_couplings, place_shape

Indices = NDArray[np.intp]

_BOX, _CYLINDER = mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_CYLINDER
_SPHERE, _MESH = mujoco.mjtGeom.mjGEOM_SPHERE, mujoco.mjtGeom.mjGEOM_MESH
# The skin of compliant fixtures is soft at first touch: with MuJoCo's default of 0.9, which spreads a force over the
# corners of flat pads, sliding objects repeatedly lose contact (`benchmarks/contact_sliding.py`).
_SKIN_SOLIMP = (0.5, 0.95, 0.001, 0.5, 2.0)
# Whose contact parameters count; pads have priority 1.
_SLIPPERY_PRIORITY, _SKIN_PRIORITY = 2, 3


@dataclass(frozen=True, kw_only=True)
class ArmIndices:
    """Addresses of one arm's joints in the model's arrays, and its bodies."""

    name: str
    model: RobotModel
    qpos: Indices
    dof: Indices
    motor: Indices
    bodies: frozenset[int]
    tool: ToolIndices | None


@dataclass(frozen=True, kw_only=True)
class CellModel:
    """The compiled world (`model` is MuJoCo's). `frames` are the bodies whose poses are published, by public name."""

    scene: SimScene
    model: Any
    arms: tuple[ArmIndices, ...]
    frames: tuple[str, ...]
    frame_bodies: Indices
    parts: tuple[str, ...]
    part_qpos: Indices
    """Addresses of the parts' poses, seven per part, in the order of `parts`."""
    free_qpos: Indices
    """Addresses of the poses of all free bodies, seven each: the parts, then those that nobody knows of."""
    free_dof: Indices
    """Addresses of the velocities of all free bodies, six each."""
    body_names: tuple[str, ...]
    people: tuple[PersonIndices, ...] = ()


def build_cell(scene: SimScene) -> CellModel:
    """Compile a scene.

    Raises:
        CellError: a robot model is unknown, a shape is invalid, or MuJoCo rejects the result.
    """
    spec = cell_spec(scene)
    models = {arm.name: arm.robot() for arm in scene.arms}
    try:
        compiled = spec.compile()
    except ValueError as error:
        raise CellError(f"the cell cannot be simulated: {error}", hint="check names, sizes and masses") from error
    ferrous = tuple(part.name for part in scene.parts if part.magnetic)
    arms = tuple(_arm_indices(compiled, arm.name, models[arm.name], ferrous=ferrous) for arm in scene.arms)
    frames = tuple(f"{arm.name}/{link}" for arm in scene.arms for link in _links(compiled, arm.name))
    frames += tuple(body for person in scene.people for body in body_names(person.name))
    # Frames are drawn; only `parts` are known by name.
    unknown = tuple(part.name for part in scene.unknown_parts)
    frames += (*unknown, *(fixture.name for fixture in scene.fixtures if fixture.moves))
    parts = tuple(part.name for part in scene.parts)
    return CellModel(
        scene=scene,
        model=compiled,
        arms=arms,
        frames=frames + parts,
        frame_bodies=np.array([compiled.body(name).id for name in frames + parts], dtype=np.intp),
        parts=parts,
        part_qpos=_ints(compiled.joint(name).qposadr[0] + i for name in parts for i in range(7)),
        free_qpos=_ints(compiled.joint(name).qposadr[0] + i for name in parts + unknown for i in range(7)),
        free_dof=_ints(compiled.joint(name).dofadr[0] + i for name in parts + unknown for i in range(6)),
        body_names=tuple(compiled.body(i).name for i in range(compiled.nbody)),
        people=tuple(person_indices(compiled, person) for person in scene.people),
    )


def cell_spec(scene: SimScene) -> Any:
    """Return a scene as MuJoCo's specification, before it is compiled.

    Raises:
        CellError: a robot model is unknown, or a shape is invalid.
    """
    spec, errors = _empty_world(scene), PlantErrors(scene)
    known = {fixture.name: fixture for fixture in scene.fixtures}
    for fixture in sorted((*scene.fixtures, *scene.unknown_fixtures), key=lambda one: bool(one.on)):
        _add_fixture(spec, fixture, known)
    for fixture in scene.fixtures:
        if fixture.hexapod is not None:
            add_legs(spec, fixture, known[fixture.hexapod.base])
    for part in (*scene.parts, *scene.unknown_parts):
        _add_part(spec, part, errors)
    for arm in scene.arms:
        _add_arm(spec, arm, arm.robot(), known, errors)
    _add_people(spec, scene)
    add_couplings(spec, scene)
    add_bonds(spec, scene.bonds)
    return spec


def _empty_world(scene: SimScene) -> Any:
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    option = spec.option
    option.timestep = scene.step_s
    if not scene.gravity:
        option.gravity = [0.0, 0.0, 0.0]
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = 20.0
    return spec


def _wxyz(pose: Pose) -> list[float]:
    x, y, z, w = pose.xyzw
    return [w, x, y, z]


def _add_fixture(spec: Any, fixture: FixtureBody, fixtures: Mapping[str, FixtureBody]) -> None:
    parent, pose = spec.worldbody, fixture.pose
    if fixture.on:
        parent, pose = spec.body(fixture.on), place_on(fixtures[fixture.on], fixture)
    body = parent.add_body(name=fixture.name, pos=list(pose.xyz), quat=_wxyz(pose))
    if fixture.mesh is not None:
        for geom in add_pieces(spec, body, fixture.name, fixture.mesh.pieces):
            _finish_piece(geom, fixture)
        return
    if fixture.shape != "tray":
        geom = _add_shape(body, fixture.name, fixture.shape, fixture.size_m, condim=3)
        if fixture.spring_n_m > 0.0:
            _add_spring(body, geom, fixture)
        if fixture.jaw_friction is not None:
            add_jaw(geom, friction=fixture.jaw_friction)
        if fixture.axis is not None:
            add_axis(spec, body, geom, fixture.name, fixture.axis)
        elif fixture.carriage is not None:
            add_slide(spec, body, geom, fixture.name, fixture.carriage)
        elif fixture.on:
            geom.mass = 0.0  # that of the platform contains it
        if fixture.belt is not None:
            add_belt(body, geom, fixture.name, fixture.belt)
        return
    for centre, size in tray_boxes(fixture):
        geom = body.add_geom(type=_BOX, pos=list(centre), size=[edge / 2 for edge in size])
        if fixture.on:
            geom.mass = 0.0


def add_pieces(spec: Any, body: Any, name: str, pieces: Iterable[Piece]) -> Iterator[Any]:
    """Add the convex pieces of a mesh to a body, and yield their geometries."""
    for index, piece in enumerate(pieces):
        asset = spec.add_mesh(name=f"{name}/{index}", uservert=np.array(piece).reshape(-1).tolist())
        # A piece may be as thin as a sheet.
        asset.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
        yield body.add_geom(name=f"{name}/{index}", type=_MESH, meshname=asset.name, condim=3)


def _finish_piece(geom: Any, fixture: FixtureBody) -> None:
    if fixture.jaw_friction is not None:
        add_jaw(geom, friction=fixture.jaw_friction)
    if fixture.on:
        geom.mass = 0.0


def _add_spring(body: Any, geom: Any, fixture: FixtureBody) -> None:
    joint = body.add_joint(name=fixture.name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0.0, 0.0, 1.0])
    joint.stiffness[0] = fixture.spring_n_m
    joint.damping[0] = fixture.spring_ns_m
    geom.mass = fixture.sprung_kg
    geom.priority, geom.solimp = _SKIN_PRIORITY, list(_SKIN_SOLIMP)
    geom.friction[0] = fixture.skin_friction


def tray_boxes(
    tray: FixtureBody,
) -> tuple[tuple[tuple[float, float, float], tuple[float, float, float]], ...]:
    """Return centre (in the tray's frame) and full edge lengths of the floor and the four walls."""
    length, width, height = tray.size_m
    wall = tray.wall_m
    rise = height - wall
    across, along, up = (length - wall) / 2, (width - wall) / 2, wall + rise / 2
    return (
        ((0.0, 0.0, wall / 2), (length, width, wall)),
        ((across, 0.0, up), (wall, width, rise)),
        ((-across, 0.0, up), (wall, width, rise)),
        ((0.0, along, up), (length - 2 * wall, wall, rise)),
        ((0.0, -along, up), (length - 2 * wall, wall, rise)),
    )


def _add_part(spec: Any, part: PartBody, errors: PlantErrors) -> None:
    body = spec.worldbody.add_body(name=part.name, pos=list(part.pose.xyz), quat=_wxyz(part.pose))
    body.add_freejoint(name=part.name)
    # Rolling friction (condim 6) keeps round parts where they are placed.
    geom = _add_shape(body, part.name, part.shape, part.size_m, condim=3 if part.shape == "box" else 6)
    geom.mass = errors.mass_kg(part)
    if part.friction is not None:
        # What counts instead of the parameters of a pad is as stiff, and resists torsion, too.
        geom.priority, geom.condim = _SLIPPERY_PRIORITY, max(int(geom.condim), 4)
        geom.solref, geom.solimp = list(PAD_SOLREF), list(PAD_SOLIMP)
        geom.friction[0] = part.friction
    for index, one in enumerate(part.tool.shapes if part.tool is not None else ()):
        more = _add_shape(body, f"{part.name}/{index}", one.shape, one.size_m, condim=3)
        place_shape(more, one, mass_factor=errors.mass_factor(part))


def _add_shape(body: Any, name: str, shape: str, size_m: tuple[float, ...], *, condim: int) -> Any:
    half = [edge / 2 for edge in size_m]
    match shape, len(half):
        case "box", 3:
            kind, size = _BOX, half
        case "cylinder", 2:
            kind, size = _CYLINDER, [half[0], half[1], 0.0]
        case "sphere", 1:
            kind, size = _SPHERE, [half[0], 0.0, 0.0]
        case _:
            raise CellError(
                f"a {shape} cannot have the size {list(size_m)}",
                where=name,
                hint="box: three edge lengths; cylinder: diameter and length; sphere: diameter",
            )
    return body.add_geom(name=name, type=kind, size=size, condim=condim)


def _add_arm(
    spec: Any, arm: ArmPlacement, model: RobotModel, fixtures: Mapping[str, FixtureBody], errors: PlantErrors
) -> None:
    base, arm_only = errors.base(arm), arm_spec(model)
    errors.apply(arm_only, model, name=arm.name)
    parent = spec.worldbody
    if arm.on:
        parent, base = spec.body(arm.on), compose_poses(invert_pose(fixtures[arm.on].pose), base)
    frame = parent.add_frame(pos=list(base.xyz), quat=_wxyz(base))
    spec.attach(arm_only, frame=frame, prefix=f"{arm.name}/")
    # The shape of the first moving link overlaps the fixture under the base.
    shoulder = spec.joint(f"{arm.name}/{model.arm_joints[0]}").parent.name
    for fixture in fixtures:
        spec.add_exclude(bodyname1=shoulder, bodyname2=fixture)
    if arm.on:
        # The guides keep the carriage, with the base on it, off everything beside the rail.
        for fixture in fixtures.values():
            if arm.on not in (fixture.name, fixture.on) and not fixture.moves:
                spec.add_exclude(bodyname1=arm.on, bodyname2=fixture.name)


def _add_people(spec: Any, scene: SimScene) -> None:
    if not scene.people:
        return
    for person in scene.people:
        add_person(spec, person)
    let_people_touch(spec)


def _links(model: Any, arm: str) -> list[str]:
    prefix = f"{arm}/"
    names = (str(model.body(i).name) for i in range(model.nbody))
    return [name.removeprefix(prefix) for name in names if name.startswith(prefix)]


def _arm_indices(model: Any, name: str, robot: RobotModel, *, ferrous: tuple[str, ...]) -> ArmIndices:
    joints = [f"{name}/{joint}" for joint in robot.arm_joints]
    prefix = f"{name}/"
    return ArmIndices(
        name=name,
        model=robot,
        qpos=_ints(model.joint(j).qposadr[0] for j in joints),
        dof=_ints(model.joint(j).dofadr[0] for j in joints),
        motor=_ints(model.actuator(j).id for j in joints),
        bodies=frozenset(i for i in range(model.nbody) if str(model.body(i).name).startswith(prefix)),
        tool=tool_body(robot.tool).indices(model, name, robot.tool, ferrous=ferrous) if robot.tool else None,
    )


def _ints(values: Iterable[Any]) -> Indices:
    return np.array([int(value) for value in values], dtype=np.intp)
