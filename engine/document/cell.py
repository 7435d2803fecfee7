"""Cell documents: robots, world, fixtures, parts, cameras and store of a work cell.

Lengths are in metres, angles in radians, masses in kilograms. Paths are relative to the document, except
`store.path`, which is relative to the current directory because it is written at run time.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta
from msgspec.structs import replace

from engine.document.cell_bodies import Fixture, PartSpec, UnknownBody, require_sizes
from engine.document.cell_bonds import BondSpec, require_bonds
from engine.document.cell_devices import DeviceSpec, require_devices
from engine.document.cell_frames import WORLD, FrameSpec, poses_in_world, require_frames
from engine.document.cell_meshes import mesh_digests
from engine.document.cell_modules import (
    ModuleSpec,
    docked,
    load_modules,
    module_below,
    require_plugged,
    with_positions,
)
from engine.document.cell_perception import (
    DepthCamera,
    OccupancyMap,
    Person,
    SpeedAndSeparationMonitoring,
    require_detection_frames,
)
from engine.document.cell_store_spec import MongoStoreSpec, SqliteStoreSpec, require_no_secret
from engine.document.cell_tools import require_changer
from engine.document.device_pins import require_device_pins
from engine.document.document_kind import require_kind
from engine.document.equipment import Equipment, EquipmentSpec, load_pins
from engine.document.hexapods.hexapod_rules import require_hexapods
from engine.document.linear_units.linear_unit_rules import require_linear_units
from engine.document.module_document import Module
from engine.document.parameter_spec import ParameterSpec
from engine.document.placement import Name
from engine.document.robot_spec import RobotSpec, require_driver_kind
from engine.document.text.decoding import StrictModel, decode_document
from engine.document.text.document_file import DocumentFile
from engine.document.text.yaml_source import DataPath, DocumentSource, load_source
from engine.document.topic_rules import RESERVED_NAMESPACES, require_topics
from engine.errors import DocumentError
from engine.messages import Pose

RealismName = Literal["ideal", "typical", "poor"]


class MujocoWorld(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="mujoco"):
    """The simulated world.

    The two timeouts are for simulations in real time on a loaded machine: a longer one lets an arm move for
    longer without supervision. `realism` says how far the arms differ from what their controllers know of them.
    """

    step_s: Annotated[float, Meta(gt=0.0, le=0.01, description="Physics step in seconds")] = 0.001
    gravity: bool = True
    realism: Annotated[
        RealismName, Meta(description="Friction, noise, delay, and errors of masses and calibration of the arms")
    ] = "typical"
    engine_silence_s: Annotated[
        float, Meta(ge=0.1, le=60.0, description="Seconds without an engine message after which all motion stops")
    ] = 0.2
    world_silence_s: Annotated[
        float, Meta(ge=0.1, le=60.0, description="Seconds without a simulation step until the world is terminated")
    ] = 0.25
    start_limit_s: Annotated[
        float, Meta(ge=1.0, le=3600.0, description="Maximum seconds until the process of the world has built it")
    ] = 180.0


class BusLimits(StrictModel, frozen=True, kw_only=True):
    """Limits of the skill bus."""

    service_timeout_s: (
        Annotated[float, Meta(gt=0.0, description="Seconds within which services answer; others have failed")] | None
    ) = None


TopicName = Annotated[
    str, Meta(pattern="^[a-z][a-z0-9_]*(/[a-z0-9_]+)+$", max_length=128, description="Such as `operator/key`")
]


class CellDocument(StrictModel, frozen=True, kw_only=True):
    """A work cell as written."""

    flexcell: Literal[1]
    cell: Name
    description: str = ""
    store: SqliteStoreSpec | MongoStoreSpec | None = None
    bus: BusLimits = BusLimits()
    world: MujocoWorld | None = None
    robots: dict[Name, RobotSpec] = {}
    equipment: dict[Name, EquipmentSpec] = {}
    fixtures: dict[Name, Fixture] = {}
    parts: dict[Name, PartSpec] = {}
    cameras: dict[Name, DepthCamera] = {}
    occupancy: OccupancyMap | None = None
    speed_and_separation_monitoring: SpeedAndSeparationMonitoring | None = None
    people: dict[Name, Person] = {}
    unknown_bodies: dict[Name, UnknownBody] = {}
    frames: Annotated[
        dict[Name, FrameSpec],
        Meta(description="Frames in which behaviors give poses, and which they find on `cell/frames`"),
    ] = {}
    connectors: Annotated[
        dict[Name, FrameSpec], Meta(description="Where modules are docked; frames of the cell too")
    ] = {}
    modules: dict[Name, ModuleSpec] = {}
    devices: dict[Name, DeviceSpec] = {}
    bonds: dict[Name, BondSpec] = {}
    topics: Annotated[
        dict[TopicName, ParameterSpec],
        Meta(description="Topics on which everybody may publish a value of the given type"),
    ] = {}

    @property
    def named_things(self) -> dict[str, Mapping[str, object]]:
        """What stands in the cell and has a name of its own, by kind; a behavior for another cell has these mapped."""
        return {
            "robot": self.robots,
            "part": self.parts,
            "fixture": self.fixtures,
            "person": self.people,
            "camera": self.cameras,
            "frame": self.frames,
        }

    @property
    def fixed_frames(self) -> dict[str, Pose]:
        """The poses of the named frames in the world."""
        poses = poses_in_world(self.frames, self.fixtures)
        return {name: poses[name] for name in self.frames}

    def uses_of_frames(self) -> Iterator[tuple[DataPath, str]]:
        """Yield in which frames things stand that are no frames, each with its path in the document."""
        yield from ((("parts", name, "at", "frame"), part.at.frame) for name, part in self.parts.items())
        yield from (
            (("unknown_bodies", name, "at", "frame"), one.at.frame) for name, one in self.unknown_bodies.items()
        )
        yield from ((("robots", name, "base", "frame"), robot.base.frame) for name, robot in self.robots.items())
        yield from ((("cameras", name, "frame"), camera.frame) for name, camera in self.cameras.items())
        yield from ((("people", name, "frame"), person.frame) for name, person in self.people.items())

    def with_modules(self, modules: Mapping[str, Module]) -> CellDocument:
        """Return the same cell with its connectors as frames, and with what stands on its modules."""
        frames, fixtures = {**self.frames, **self.connectors}, dict(self.fixtures)
        parts, cameras, devices, bonds = dict(self.parts), dict(self.cameras), dict(self.devices), dict(self.bonds)
        for name, module in modules.items():
            spec = self.modules[name]
            added = docked(name, module.document, connector=spec.connector or WORLD, equipment=spec.equipment)
            frames |= added.frames
            fixtures |= added.fixtures
            parts |= added.parts
            cameras |= added.cameras
            devices |= added.devices
            bonds |= added.bonds
        return replace(
            self, frames=frames, fixtures=fixtures, parts=parts, cameras=cameras, devices=devices, bonds=bonds
        )

    def in_world(self) -> CellDocument:
        """Return the same cell with everything placed in the world."""
        poses = poses_in_world(self.frames, self.fixtures)
        named = {name: poses[name] for name in self.frames}
        return replace(
            self,
            robots={name: replace(robot, base=robot.base.in_world(poses)) for name, robot in self.robots.items()},
            fixtures={name: replace(each, at=each.at.in_world(poses)) for name, each in self.fixtures.items()},
            parts={name: replace(part, at=part.at.in_world(poses)) for name, part in self.parts.items()},
            unknown_bodies={
                name: replace(body, at=body.at.in_world(poses)) for name, body in self.unknown_bodies.items()
            },
            cameras={name: camera.in_world(poses, named=named) for name, camera in self.cameras.items()},
            people={name: person.in_world(poses) for name, person in self.people.items()},
        )

    @property
    def real_devices(self) -> dict[str, str]:
        """The devices that are not simulated, `left`, `left/gripper` or `vice`, with the names of their drivers."""
        arms = {name: robot.driver_kind for name, robot in self.robots.items() if not robot.simulated}
        tools = {name: robot.gripper.driver_kind for name, robot in self.robots.items() if robot.gripper is not None}
        equipment = {name: each.driver_kind for name, each in self.equipment.items() if not each.simulated}
        return arms | {f"{name}/gripper": kind for name, kind in tools.items() if kind} | equipment


@dataclass(frozen=True, kw_only=True)
class Cell(DocumentFile[CellDocument]):
    """A cell document with its file, and with everything that stands on its modules.

    `modules` are their documents; `carried` says, by module, what of the cell document itself stands on it and is no
    part: `robot arm`. `simulated` are devices whose drivers the simulation replaces, with these. `pins` are the
    documents of its equipment. `meshes` are the digests of its mesh files when it was read, by path as it names them.
    """

    modules: Mapping[str, Module] = field(default_factory=dict[str, Module])
    carried: Mapping[str, str] = field(default_factory=dict[str, str])
    simulated: Mapping[str, str] = field(default_factory=dict[str, str])
    pins: Mapping[str, Equipment] = field(default_factory=dict[str, Equipment])
    meshes: Mapping[str, str] = field(default_factory=dict[str, str])

    @property
    def name(self) -> str:
        """The name of the cell."""
        return self.document.cell

    @property
    def content(self) -> tuple[object, ...]:
        """The plain data of the document, its modules and its equipment, to compare it with another reading.

        The digests of its mesh files are the last: another mesh is another cell.
        """
        documents = (each.source.data for each in (*self.modules.values(), *self.pins.values()))
        return self.source.data, *documents, self.meshes

    @property
    def seed_file(self) -> Path | None:
        """The resolved path of the entries document that seeds the store; None without one."""
        store = self.document.store
        return self.resolve(store.seed) if store is not None and store.seed is not None else None

    def resolve(self, path: str) -> Path:
        """Return a path of the document, resolved against the folder of the document."""
        return (self.file.parent / path).resolve()


def load_cell(path: Path | str) -> Cell:
    """Read a cell document.

    Raises:
        DocumentError: the file cannot be read or is not a valid cell; `where` is the position.
    """
    return cell_of_source(load_source(Path(path)), file=Path(path))


def cell_of_source(source: DocumentSource, *, file: Path) -> Cell:
    """Return the cell that parsed data describe; `file` is what its paths are relative to.

    Raises:
        DocumentError: as `load_cell`.
    """
    try:
        document = written = decode_document(source, CellDocument, refused=_REFUSED)
    except DocumentError:
        require_kind(source, "cell")
        raise
    modules: dict[str, Module] = {}
    if document.modules or document.connectors:
        _require_free_names(document, source)
        connectors = document.connectors
        modules = load_modules(document.modules, connectors=connectors, source=source, folder=file.parent)
        document, source = document.with_modules(modules), with_positions(source, modules)
    require_no_secret(document.store, source)
    require_sizes(document.fixtures, document.parts, source, unknown_bodies=document.unknown_bodies)
    on_bus = {**dict.fromkeys(document.robots, "robot"), **dict.fromkeys(document.cameras, "camera")}
    require_devices(document.devices, source, fixtures=document.fixtures, taken=on_bus)
    require_bonds(document.bonds, source, parts=document.parts, fixtures=document.fixtures)
    _require_drivers(document, source)
    _require_world(document, source)
    _require_people(document, source)
    _require_unknown_bodies(document, source)
    _require_regions(document, source)
    require_detection_frames(document.cameras, document.frames, source)
    require_topics(document.topics, source, owners={**on_bus, **dict.fromkeys(document.equipment, "equipment")})
    taken = {**_bodies(document), **dict.fromkeys((*document.people, *document.unknown_bodies), "body")}
    require_frames(document.frames, source, fixtures=document.fixtures, uses=document.uses_of_frames(), taken=taken)
    fixtures, frames, uses = document.fixtures, document.frames, tuple(document.uses_of_frames())
    require_hexapods(document.devices, source, fixtures=fixtures, frames=frames, uses=uses)
    require_linear_units(document.devices, source, robots=document.robots, fixtures=fixtures, frames=frames, uses=uses)
    carried = _items_on_modules(written, document, source, modules) if modules else {}
    pins = load_pins(document.equipment, source, folder=file.parent, taken=_namespaces(document))
    require_device_pins(
        document.devices, source, document.modules, document.equipment, pins, has_world=document.world is not None
    )
    meshes = mesh_digests((one.file for one in document.fixtures.values()), file.parent)
    document = document.in_world()
    return Cell(document=document, file=file, source=source, modules=modules, carried=carried, pins=pins, meshes=meshes)


def _items_on_modules(
    written: CellDocument, joined: CellDocument, source: DocumentSource, modules: Mapping[str, Module]
) -> dict[str, str]:
    """Return what of the cell document stands on each module, without parts."""
    fixtures = [(("fixtures", name, "at", "frame"), one.at.frame) for name, one in written.fixtures.items()]
    uses: list[tuple[DataPath, str]] = [*written.uses_of_frames(), *fixtures]
    frames: dict[str, str] = {"world": ""}
    for _, frame in (*uses, *(((), name) for name in written.connectors)):
        frames[frame] = module_below(frame, modules=modules, frames=joined.frames, fixtures=joined.fixtures)
    resting = [(path, frames[frame]) for path, frame in uses if frames[frame]]
    below = {name: frames[name] for name in written.connectors if frames[name]}
    require_plugged(written.modules, modules, source, resting=resting, below=below)
    return {module: f"{str(path[0])[:-1]} {path[1]}" for path, module in resting if path[0] != "parts"}


_REFUSED = {"calibration": "give it to the robot: `robots: {NAME: {calibration: FILE}}`"}


def _require_free_names(document: CellDocument, source: DocumentSource) -> None:
    """Require that connectors and modules, which are frames, have names of their own."""
    taken = {**_bodies(document), **dict.fromkeys((*document.people, *document.unknown_bodies), "body")}
    taken |= {**dict.fromkeys(document.frames, "frame"), **dict.fromkeys(document.cameras, "camera")}
    for section, noun in (("connectors", "connector"), ("modules", "module")):
        names: Mapping[str, object] = getattr(document, section)
        for name in names:
            if name in taken:
                raise DocumentError(
                    f"`{name}` is both a {noun} and a {taken[name]}",
                    where=source.position((section, name), of_key=True),
                    hint="rename one",
                )
            taken[name] = noun


def _require_drivers(document: CellDocument, source: DocumentSource) -> None:
    for name, robot in document.robots.items():
        require_driver_kind(f"robot `{name}`", robot.driver, source, ("robots", name, "driver"))
        require_changer(name, robot.tool_changer, source, tool=robot.gripper is not None, simulated=robot.simulated)
        if robot.gripper is not None:
            path: DataPath = ("robots", name, "gripper", "driver")
            require_driver_kind(f"the gripper of `{name}`", robot.gripper.driver, source, path)


def _require_world(document: CellDocument, source: DocumentSource) -> None:
    if document.world is not None:
        return
    for name, robot in document.robots.items():
        if robot.simulated:
            raise DocumentError(
                f"robot `{name}` is simulated, but the cell has no world",
                where=source.position(("robots", name), of_key=True),
                hint="add `world: {kind: mujoco}`",
            )


def _require_people(document: CellDocument, source: DocumentSource) -> None:
    for name, person in document.people.items():
        path: DataPath = ("people", name)
        _require_simulated(document, source, path, noun="person", taken=_bodies(document))
        least_m, greatest_m = person.reach_m
        away_m = math.dist(person.shoulder, person.hand_rests)
        if not least_m <= away_m <= greatest_m:
            raise DocumentError(
                f"the hand of person `{name}` cannot rest {away_m:.3f} m from the shoulder",
                where=source.position((*path, "hand_rests")),
                hint=f"its reach is {least_m:.3f} to {greatest_m:.3f} m",
            )


def _require_unknown_bodies(document: CellDocument, source: DocumentSource) -> None:
    taken = {**_bodies(document), **dict.fromkeys(document.people, "person")}
    for name in document.unknown_bodies:
        _require_simulated(document, source, ("unknown_bodies", name), noun="unknown body", taken=taken)


def _bodies(document: CellDocument) -> dict[str, str]:
    """Return what has each name in the world."""
    return {
        **dict.fromkeys(document.parts, "part"),
        **dict.fromkeys(document.fixtures, "fixture"),
        **dict.fromkeys(document.robots, "robot"),
    }


def _require_simulated(
    document: CellDocument, source: DocumentSource, path: DataPath, *, noun: str, taken: Mapping[str, str]
) -> None:
    """Require a world for what only simulation has, and a name of its own in it."""
    name = str(path[-1])
    if document.world is None:
        raise DocumentError(
            f"{noun} `{name}` is simulated, but the cell has no world",
            where=source.position(path, of_key=True),
            hint="add `world: {kind: mujoco}`",
        )
    if name in taken:
        article = "an" if noun[0] in "aeiou" else "a"
        raise DocumentError(
            f"`{name}` is both {article} {noun} and a {taken[name]}",
            where=source.position(path, of_key=True),
            hint="rename one",
        )


def _require_regions(document: CellDocument, source: DocumentSource) -> None:
    if document.occupancy is not None and document.occupancy.must_cover and not document.cameras:
        raise DocumentError(
            "regions must be covered, but the cell has no camera",
            where=source.position(("occupancy", "must_cover"), of_key=True),
            hint="add `cameras:`",
        )
    if document.speed_and_separation_monitoring and not (document.cameras and document.occupancy):
        raise DocumentError(
            "nothing measures the distance of people",
            where=source.position(("speed_and_separation_monitoring",), of_key=True),
            hint="add `cameras:` and `occupancy:`",
        )


def _namespaces(document: CellDocument) -> dict[str, str]:
    """Return what has each namespace on the bus, without equipment."""
    found = {**dict.fromkeys(document.robots, "robot"), **dict.fromkeys(document.cameras, "camera")}
    return (
        found | dict.fromkeys(document.people, "person") | dict.fromkeys(RESERVED_NAMESPACES, "name of flexcell itself")
    )
