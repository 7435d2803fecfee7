"""MotionBenchMaker's problems for a Panda, which vamp's source distribution ships: `--problems` of `planning.py`.

`pip download vamp-planner==0.6.4 --no-binary vamp-planner --no-deps` fetches `vamp_planner-0.6.4.tar.gz`, in which
`resources/panda/problems.tar.bz2` has seven sets of a hundred: scenes of boxes, cylinders and spheres and requests
between two configurations, as MoveIt writes them (Chamzas et al., "MotionBenchMaker", 2022). Nothing is copied here.

The arm is the one of the sets, from the same file: its URDF and SRDF with the fingers fixed open, and convex hulls
of its meshes. Vamp itself takes spheres in their place: ends that touch exactly are counted and left out.
"""

from __future__ import annotations

import io
import tarfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from benchmarks.planning_scenes import ARM, Case, alone
from engine.document.text.yaml_source import parse_source
from engine.messages import Pose
from engine.messages.shapes import Box, Cylinder, Obstacle, Shape, Solid, Sphere
from robots.model.transform import RigidTransform
from robots.planning.request import JointGoal, PlanRequest
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import PlanningScene

_INNER = "resources/panda/problems.tar.bz2"
_MODEL = """\
flexcell: 1
robot: mbm_panda
title: The Panda of the problem sets
sources: Limits of the joints from the URDF; the rest of no matter here.
urdf: {file: panda.urdf}
flange: panda_hand
joints:
"""
_JOINT = (
    "  - {name: %s, lower_rad: %s, upper_rad: %s, velocity_rad_s: %s, acceleration_rad_s2: 10.0,"
    " jerk_rad_s3: 5000.0, effort_nm: 87.0, home_rad: %s}\n"
)
_REST = """\
collisions:
  srdf: {file: panda.srdf}
licence: {name: Apache-2.0, file: LICENSE.txt}
"""
_HOME = (0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785)
_Numbers = tuple[float, ...]


class _Place(msgspec.Struct):
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float]


class _Primitive(msgspec.Struct):
    type: str
    dimensions: _Numbers


class _Thing(msgspec.Struct):
    id: str
    primitives: tuple[_Primitive, ...]
    primitive_poses: tuple[_Place, ...]
    pose: _Place | None = None


class _World(msgspec.Struct):
    collision_objects: tuple[_Thing, ...]


class _Scene(msgspec.Struct):
    world: _World


class _Joints(msgspec.Struct):
    name: tuple[str, ...]
    position: _Numbers


class _State(msgspec.Struct):
    joint_state: _Joints


class _JointValue(msgspec.Struct):
    joint_name: str
    position: float


class _Goal(msgspec.Struct):
    joint_constraints: tuple[_JointValue, ...]


class _Request(msgspec.Struct):
    start_state: _State
    goal_constraints: tuple[_Goal, ...]


@dataclass(frozen=True, kw_only=True)
class ProblemSet:
    """The problems of one set whose ends are free; how many were left out, and why."""

    name: str
    cases: tuple[Case, ...]
    touching: int
    outside: int


def problem_sets(file: Path, folder: Path, *, most: int = 1000) -> Iterator[ProblemSet]:
    """Yield the sets of vamp's source distribution, with `most` problems each at most; the arm goes to `folder`.

    Raises:
        OSError, tarfile.TarError, KeyError: the file is not there, or is not that of vamp.
    """
    with tarfile.open(file) as archive:
        documents = _documents(archive)
        _write_arm(archive, folder)
    for name in sorted({folder for folder, _ in documents}):
        numbers = sorted(
            stem.removeprefix("scene") for folder, stem in documents if folder == name and stem.startswith("scene")
        )
        cases: list[Case] = []
        touching = outside = 0
        for number in numbers[:most]:
            case = _case(
                name, number, documents[name, f"scene{number}"], documents[name, f"request{number}"], alone(str(folder))
            )
            checker = ExactChecker(case.request.scene, ARM)
            assert isinstance(case.request.goal, JointGoal)
            ends = np.array([case.request.start_rad, case.request.goal.joints_rad[0]])
            limits = checker.model.limits
            if (ends < limits.lower_rad).any() or (ends > limits.upper_rad).any():
                outside += 1
            elif any(checker.in_collision(joints) for joints in ends):
                touching += 1
            else:
                cases.append(case)
        yield ProblemSet(name=name.removesuffix("_panda"), cases=tuple(cases), touching=touching, outside=outside)


def _write_arm(archive: tarfile.TarFile, folder: Path) -> None:
    """Write the arm of the sets as a folder of a model."""
    for member in archive.getmembers():
        place = member.name.partition("/")[2]
        inside = place.removeprefix("resources/panda/")
        is_needed = place == "LICENSE.txt" or (inside != place and inside.endswith((".urdf", ".srdf", ".obj", ".mtl")))
        content = archive.extractfile(member) if is_needed else None
        if content is not None:
            (folder / inside).parent.mkdir(parents=True, exist_ok=True)
            # The meshes lie beside the URDF, not in a package.
            (folder / inside).write_bytes(content.read().replace(b"package://meshes/", b"meshes/"))
    joints = "".join(
        _JOINT % (joint.get("name"), *(limit.get(key) for key in ("lower", "upper", "velocity")), home)
        for joint, limit, home in zip(*_joints(folder / "panda.urdf"), _HOME, strict=True)
    )
    (folder / "robot.yaml").write_text(_MODEL + joints + _REST, encoding="utf-8")


def _joints(urdf: Path) -> tuple[list[ET.Element], list[ET.Element]]:
    joints = [joint for joint in ET.parse(urdf).getroot().iter("joint") if joint.get("type") == "revolute"]
    return joints, [limit for joint in joints for limit in joint.iter("limit")]


def _documents(archive: tarfile.TarFile) -> dict[tuple[str, str], bytes]:
    """Return the documents by the name of their set and their own."""
    inner = next((member for member in archive.getmembers() if member.name.endswith(_INNER)), None)
    content = archive.extractfile(inner) if inner is not None else None
    if content is None:
        raise KeyError(_INNER)
    with tarfile.open(fileobj=io.BytesIO(content.read())) as problems:
        return _read(problems)


def _read(archive: tarfile.TarFile) -> dict[tuple[str, str], bytes]:
    found: dict[tuple[str, str], bytes] = {}
    for member in archive.getmembers():
        content = archive.extractfile(member) if member.name.endswith(".yaml") else None
        if content is not None:
            path = Path(member.name)
            found[path.parent.name, path.stem] = content.read()
    return found


def _case(folder: str, number: str, scene: bytes, request: bytes, arm: PlanningScene) -> Case:
    world = msgspec.convert(parse_source(scene, file=f"scene{number}.yaml").data, _Scene).world
    asked = msgspec.convert(parse_source(request, file=f"request{number}.yaml").data, _Request)
    placed = arm.with_obstacles(*(_obstacle(thing) for thing in world.collision_objects))
    names = placed.arm(ARM).placement.robot().arm_joints
    start = dict(zip(asked.start_state.joint_state.name, asked.start_state.joint_state.position, strict=True))
    goal = {value.joint_name: value.position for value in asked.goal_constraints[0].joint_constraints}
    return Case(
        title=f"{folder} {number}",
        request=PlanRequest(
            scene=placed,
            arm=ARM,
            start_rad=tuple(start[name] for name in names),
            goal=JointGoal(joints_rad=(tuple(goal[name] for name in names),)),
        ),
    )


def _obstacle(thing: _Thing) -> Obstacle:
    at = _rigid(thing.pose) if thing.pose is not None else RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    solids = tuple(
        Solid(shape=_shape(one), pose=at.then(_rigid(place)).to_pose("world"))
        for one, place in zip(thing.primitives, thing.primitive_poses, strict=True)
    )
    return Obstacle(name=thing.id, solids=solids, pose=Pose(xyz=(0.0, 0.0, 0.0)))


def _rigid(place: _Place) -> RigidTransform:
    turn = np.array(place.orientation)
    return RigidTransform.of(place.position, turn / np.linalg.norm(turn))


def _shape(primitive: _Primitive) -> Shape:
    match primitive.type, primitive.dimensions:
        case "box", (x, y, z):
            return Box(size_m=(x, y, z))
        case "cylinder", (length, radius):
            return Cylinder(radius_m=radius, length_m=length)
        case "sphere", (radius,):
            return Sphere(radius_m=radius)
        case kind, sizes:
            raise KeyError(f"no shape is called {kind} with {len(sizes)} sizes")
