"""Messages between the process that owns the client library and its supervisor."""

from __future__ import annotations

import msgspec

SixNumbers = tuple[float, float, float, float, float, float]
HEARTBEAT_S = 0.05


class ConnectController(msgspec.Struct, frozen=True, kw_only=True, tag="connect"):
    """Read a controller; the first request. Commands nothing."""

    host: str


class EnableMotion(msgspec.Struct, frozen=True, kw_only=True, tag="enable"):
    """Upload the control script, arm the watchdog, and set tool and payload."""

    tcp_offset: SixNumbers = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    payload_kg: float = 0.0
    payload_cog_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    watchdog_hz: float = 10.0
    """The controller ends the program when it hears nothing for a period of this frequency."""


class MoveJointsRequest(msgspec.Struct, frozen=True, kw_only=True, tag="move_joints"):
    """Move to joint angles; answered when the arm is at rest."""

    q_rad: SixNumbers
    speed_rad_s: float
    acceleration_rad_s2: float


class StopMotion(msgspec.Struct, frozen=True, kw_only=True, tag="stop"):
    """Bring the arm to rest on its path; the motion under way is answered."""

    deceleration_rad_s2: float


class ControllerConnected(msgspec.Struct, frozen=True, kw_only=True, tag="connected"):
    """The answer to `ConnectController`."""


class MotionEnabled(msgspec.Struct, frozen=True, kw_only=True, tag="enabled"):
    """The answer to `EnableMotion`."""


class UrMotionReport(msgspec.Struct, frozen=True, kw_only=True, tag="motion"):
    """The answer to `MoveJointsRequest`."""

    is_reached: bool
    is_stopped: bool
    """Whether `StopMotion` has ended it."""
    safety_bits: int
    robot_mode: int
    is_program_running: bool


class ControllerHeartbeat(msgspec.Struct, frozen=True, kw_only=True, tag="heartbeat"):
    """Twenty times a second: what the controller measures, and whether it is fresh."""

    controller_time_s: float
    is_fresh: bool
    """Whether the time of the controller has advanced since the heartbeat before."""
    q_rad: SixNumbers
    qd_rad_s: SixNumbers
    tcp_pose: SixNumbers
    safety_bits: int
    robot_mode: int
    digital_outputs: int
    speed_scaling: float


class LinkLost(msgspec.Struct, frozen=True, kw_only=True, tag="link_lost"):
    """The last message of a process: the library has lost the controller, and is of no use any more."""


class LibraryFailure(msgspec.Struct, frozen=True, kw_only=True, tag="library_failure"):
    """What the client library has raised, or that it has returned False."""

    message: str


ToUrProcess = ConnectController | EnableMotion | MoveJointsRequest | StopMotion
FromUrProcess = ControllerConnected | MotionEnabled | UrMotionReport | ControllerHeartbeat | LinkLost | LibraryFailure
