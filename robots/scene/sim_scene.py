"""The scene of a simulated cell as plain data that can be sent to another process.

All poses are in the world frame; sizes are metres. `box` has full edge lengths, `cylinder`
(diameter, length along z), `sphere` its diameter; a `tray` has outer edge lengths and
its pose is the centre of its bottom face, that of a `mesh` the origin of its file, every other pose is the centre of
the body.
"""

from __future__ import annotations

from pathlib import Path

import msgspec

from engine.document import BondSpec, RealismName, ToolChangerSpec, ToolSpec, arm_reach_m
from engine.messages import Pose, Vector3
from robots.model.meshes.convex_pieces import Piece
from robots.model.registry import OWN_TOOL, robot_model
from robots.model.robot_model import RobotModel
from robots.model.urdf.visual_mesh import VisualMesh
from robots.port import SeparationRule
from robots.port.heartbeat import CONTROL_SILENCE_S, ENGINE_SILENCE_S

Rgba = tuple[float, float, float, float]
GREY: Rgba = (0.7, 0.7, 0.7, 1.0)
LOOSE_HINT = "lock the brakes of its linear unit first"
"""What to do about an arm whose base is loose."""


class ArmPlacement(msgspec.Struct, frozen=True, kw_only=True):
    """One arm: its name in the cell, its models and its base pose.

    `model` and `gripper` are names or folders of models; `gripper` is None for a bare flange.
    `calibration` is the path of the arm's factory calibration file. A `driven_tool` has a driver of its own: the world
    simulates its body, with its fingers at rest, and neither commands it nor publishes its state. A `driven` arm has a
    driver too: the world places its body where the driver measures it, and simulates no motors. `digital_outputs` and
    `digital_inputs` are those of its controller, None for as many as the model has. With a `tool_changer` there is no
    gripper: the arm takes parts that are tools. What it stands `on` is a carriage, which moves its base; the base is
    `loose` while the brakes of that carriage are released.
    """

    name: str
    model: str
    base: Pose
    gripper: str | None = OWN_TOOL
    calibration: str | None = None
    coupled_joints: bool = False
    driven_tool: bool = False
    driven: bool = False
    digital_outputs: int | None = None
    digital_inputs: int | None = None
    tool_changer: ToolChangerSpec | None = None
    on: str = ""
    loose: bool = False

    def robot(self) -> RobotModel:
        """Return the model of the arm with its tool.

        Raises:
            CellError: a model is unknown, or the arm has no such option.
            DocumentError: a document of a model folder is invalid.
        """
        return robot_model(
            self.model,
            gripper=self.gripper,
            calibration=Path(self.calibration) if self.calibration is not None else None,
            coupled_joints=self.coupled_joints,
            changer=self.tool_changer,
        )


class AxisBody(msgspec.Struct, frozen=True, kw_only=True):
    """The joint of a fixture that a device moves: from 0, its pose in the scene, to `stroke` in m or rad.

    `force` in N or N m is what it presses with; `speed` in m/s or rad/s is that of the free axis.
    """

    hinge: bool
    along: Vector3
    stroke: float
    force: float
    speed: float
    mass_kg: float
    cuts: tuple[str, ...] = ()
    """The kinds of bonds that its body cuts."""


class BeltBody(msgspec.Struct, frozen=True, kw_only=True):
    """The running surface of a fixture: its direction in the frame of the fixture, its speed and how that changes."""

    along: Vector3
    speed_m_s: float
    acceleration_m_s2: float


class HexapodBody(msgspec.Struct, frozen=True, kw_only=True):
    """The six legs of a passive platform to the fixture `base`; each has its joint in the frame of either plate.

    A leg has its friction between `friction_n`, released, and `holding_n`, braked; `mass_kg` is that of the platform.
    """

    base: str
    feet: tuple[Vector3, ...]
    joints: tuple[Vector3, ...]
    length_m: tuple[float, float]
    mass_kg: float
    friction_n: float
    damping_ns_m: float
    holding_n: float


class CarriageBody(msgspec.Struct, frozen=True, kw_only=True):
    """The slide of the carriage of a linear unit: along a unit vector in its frame, from 0, its pose in the scene.

    It slips at `friction_n` while it is released and at `holding_n` braked.
    """

    along: Vector3
    travel_m: tuple[float, float]
    mass_kg: float
    friction_n: float
    damping_ns_m: float
    holding_n: float


class MeshBody(msgspec.Struct, frozen=True, kw_only=True):
    """The mesh of a fixture, in its frame: its convex `pieces` are what bodies touch, its `looks` what is drawn."""

    pieces: tuple[Piece, ...]
    looks: tuple[VisualMesh, ...]


class FixtureBody(msgspec.Struct, frozen=True, kw_only=True):
    """A static body; `wall_m` is the thickness of a tray's floor and walls.

    With `spring_n_m` above 0 it rests on a spring and a damper and yields along its z axis, like foam
    or a workpiece on a compliant table; it then weighs `sprung_kg`, and its soft skin has
    `skin_friction` with any other body. With an `axis` it is moved by a device, with a `belt` its surface is.
    `jaw_friction` is that of the surface of what a device presses with, or against, or carries with. With a `hexapod`
    it is a platform on legs; what is `on` a platform or a `carriage` is fixed to it, or has its axis on it. With the
    shape `mesh` it has a `mesh` and no size.
    """

    name: str
    shape: str
    size_m: tuple[float, ...]
    pose: Pose
    wall_m: float = 0.005
    spring_n_m: float = 0.0
    spring_ns_m: float = 60.0
    sprung_kg: float = 0.1
    skin_friction: float = 0.3
    axis: AxisBody | None = None
    belt: BeltBody | None = None
    jaw_friction: float | None = None
    hexapod: HexapodBody | None = None
    carriage: CarriageBody | None = None
    on: str = ""
    mesh: MeshBody | None = None
    rgba: Rgba = GREY

    @property
    def moves(self) -> bool:
        """Whether its pose changes while the cell is open."""
        return any(one is not None for one in (self.axis, self.hexapod, self.carriage)) or bool(self.on)


class PartBody(msgspec.Struct, frozen=True, kw_only=True):
    """A free body with uniform density; `magnetic` if it is of iron or steel.

    Without `friction` the contact has the larger coefficient of the two bodies, or that of a pad. A part with a `tool`
    is the plate of a tool, to which further bodies are fixed; `mass_kg` is that of the plate alone.
    """

    name: str
    shape: str
    size_m: tuple[float, ...]
    mass_kg: float
    pose: Pose
    magnetic: bool = False
    friction: float | None = None
    rgba: Rgba = GREY
    tool: ToolSpec | None = None

    @property
    def face_m(self) -> float:
        """How far the face of the plate of a tool is from its centre, towards -z."""
        return self.size_m[-1] / 2.0


class PersonBody(msgspec.Struct, frozen=True, kw_only=True):
    """A person's arm: `shoulder` is fixed; the centre of the hand, a ball, starts at `hand_rests`.

    `upper_arm_m` is from shoulder to elbow, `forearm_m` from there to the centre of the hand. It follows its motion
    where nothing pushes it off, and passes through other people only.
    """

    name: str
    shoulder: Vector3
    hand_rests: Vector3
    upper_arm_m: float = 0.32
    forearm_m: float = 0.36
    radius_m: float = 0.05
    rgba: Rgba = GREY

    @property
    def reach_m(self) -> tuple[float, float]:
        """Minimum and maximum distance of the hand from the shoulder."""
        return arm_reach_m(self.upper_arm_m, self.forearm_m, self.radius_m)


class ModuleBodies(msgspec.Struct, frozen=True, kw_only=True):
    """The bodies of one module by their names in the scene, whose poses hold for the module's frame at `at`.

    While it is not `plugged` at the start, none of them is in the world.
    """

    name: str
    at: Pose
    plugged: bool = True
    fixtures: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()


class SimScene(msgspec.Struct, frozen=True, kw_only=True):
    """The complete description of a simulated world; equal scenes give equal worlds, bit for bit.

    In real time, `engine_silence_s` and `world_silence_s` are the maximum silences of engine and world before the
    other side reacts, see `robots.port.control_process`; `start_limit_s` limits how long its process builds the world.
    The named `frames` are published with those of bodies and are nothing in the physics.
    The unknown bodies are in the physics and in images of cameras, but in no planning scene and among no parts.
    With `separation` the speed of all arms follows their measured distance from people.
    The errors of the arms that `realism` names are drawn with `seed`, see `robots.scene.realism`.
    The bodies of all `modules` are in it, plugged or not: a world is built once, and modules come and go in it.
    The `bonds` have the limits that were drawn for this world.
    """

    step_s: float = 0.001
    engine_silence_s: float = ENGINE_SILENCE_S
    world_silence_s: float = CONTROL_SILENCE_S
    start_limit_s: float = 180.0
    gravity: bool = True
    realism: RealismName = "typical"
    seed: int = 0
    arms: tuple[ArmPlacement, ...] = ()
    fixtures: tuple[FixtureBody, ...] = ()
    parts: tuple[PartBody, ...] = ()
    people: tuple[PersonBody, ...] = ()
    frames: dict[str, Pose] = {}
    unknown_fixtures: tuple[FixtureBody, ...] = ()
    unknown_parts: tuple[PartBody, ...] = ()
    separation: SeparationRule | None = None
    modules: tuple[ModuleBodies, ...] = ()
    bonds: dict[str, BondSpec] = {}
