"""Commands to a simulation, as messages that can also be sent to its own process."""

from __future__ import annotations

import msgspec

from engine.messages import Pose
from engine.skills.people import Reach
from engine.skills.simulated_world import PushBody
from robots.control.commanding.arm_commands import ArmCommand, ControlCommand, MotionCommand
from robots.port import Array


class MoveTool(ControlCommand, frozen=True, kw_only=True, tag="move_tool"):
    """Start a motion of the tool of `arm`; its kind says what the numbers of `goal` are."""

    arm: str
    motion: int
    goal: tuple[float, ...]


class MirrorArm(ControlCommand, frozen=True, kw_only=True, tag="mirror_arm"):
    """Place the body of a driven arm where it is measured: joints, (n,), rad and rad/s."""

    arm: str
    position_rad: Array
    velocity_rad_s: Array


class MirrorTool(ControlCommand, frozen=True, kw_only=True, tag="mirror_tool"):
    """Let the part at a driven tool follow it while the tool reports that it holds something."""

    arm: str
    held: bool


class MirrorPart(ControlCommand, frozen=True, kw_only=True, tag="mirror_part"):
    """Keep a part where another world has it, at rest, until that says something else; free it with None."""

    part: str
    pose: Pose | None


class ResetFreeParts(ControlCommand, frozen=True, kw_only=True, tag="reset_parts"):
    """Return the free parts to their poses in the scene, at rest."""


class PushSimBody(ControlCommand, frozen=True, kw_only=True, tag="push"):
    """Push a body."""

    push: PushBody


class DriveAxis(ControlCommand, frozen=True, kw_only=True, tag="drive_axis"):
    """Press the axis of a fixture towards its stroke, 1, or towards 0, -1, or not at all, 0; or keep it `locked`."""

    fixture: str
    direction: float
    locked: bool = False


class BrakeLegs(ControlCommand, frozen=True, kw_only=True, tag="brake_legs"):
    """Let each leg of a platform slip at a force along it from the next step on, in N."""

    platform: str
    force_n: float


class BrakeCarriage(ControlCommand, frozen=True, kw_only=True, tag="brake_carriage"):
    """Let the carriage of a linear unit slip at a force from the next step on, in N; `released`, it has no brake."""

    carriage: str
    force_n: float
    released: bool


class SwitchToolLock(ControlCommand, frozen=True, kw_only=True, tag="switch_tool_lock"):
    """Turn the output of the tool changer of an arm on or off."""

    arm: str
    on: bool


class MovePersonHand(ControlCommand, frozen=True, kw_only=True, tag="move_hand"):
    """Move the hand of a person."""

    reach: Reach


class RestoreWorld(ControlCommand, frozen=True, kw_only=True, tag="restore"):
    """Restore an image of this world, at rest; its numbers are as in `ImageLayout`."""

    image: Array


class PlaceModule(ControlCommand, frozen=True, kw_only=True, tag="place_module"):
    """Request: plug a module with its frame at `pose` in the world, or unplug it, None; answered by `ModulePlaced`."""

    module: str
    pose: Pose | None


class ModulePlaced(msgspec.Struct, frozen=True, kw_only=True, tag="module_placed"):
    """The answer to `PlaceModule`: why nothing was changed, empty if it was; and the parts of modules that are away."""

    refused: str = ""
    away: tuple[str, ...] = ()


class ShutDownWorld(ControlCommand, frozen=True, kw_only=True, tag="shutdown"):
    """Bring everything to rest, then end the world's process."""


AnyCommand = (
    ArmCommand
    | MoveTool
    | MotionCommand
    | MirrorArm
    | MirrorTool
    | MirrorPart
    | ResetFreeParts
    | PushSimBody
    | DriveAxis
    | BrakeLegs
    | BrakeCarriage
    | SwitchToolLock
    | MovePersonHand
    | RestoreWorld
    | ShutDownWorld
)
