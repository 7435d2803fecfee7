"""Commands to the control loop of an arm, as messages that can also be sent to its own process."""

from __future__ import annotations

import msgspec

from engine.skills.arm_control import ControlSettings
from robots.port import ContactCondition, ForceTask, JointTrajectory, MeasuredSeparation, StreamKind, Tolerance


class ControlCommand(msgspec.Struct, frozen=True, kw_only=True, tag_field="command"):
    """Base of the commands; the sender numbers motions from 1, each number once."""


class CommandToArm(ControlCommand, frozen=True, kw_only=True):
    """Base of the commands to one arm."""

    arm: str


class FollowTrajectory(CommandToArm, frozen=True, kw_only=True, tag="follow"):
    """Follow a trajectory, ended by a contact if there is a condition for it."""

    motion: int
    trajectory: JointTrajectory
    tolerance: Tolerance
    until: ContactCondition | None = None


class TrackForce(CommandToArm, frozen=True, kw_only=True, tag="track_force"):
    """Follow a tool path under force control."""

    motion: int
    task: ForceTask
    tolerance: Tolerance


class StartStream(CommandToArm, frozen=True, kw_only=True, tag="listen"):
    """Follow the `Setpoint` commands until `FinishStream` or `CancelMotion`."""

    motion: int
    kind: StreamKind
    watchdog_s: float


class StartGuiding(CommandToArm, frozen=True, kw_only=True, tag="float"):
    """Start guiding by hand, with this share of the joint damping, until `FinishStream` or `CancelMotion`."""

    motion: int
    damping: float


class Setpoint(CommandToArm, frozen=True, kw_only=True, tag="setpoint"):
    """Target positions or velocities of a stream, sent `age_s` ago."""

    motion: int
    values: tuple[float, ...]
    age_s: float = 0.0


class FinishStream(CommandToArm, frozen=True, kw_only=True, tag="finish"):
    """Bring a stream to rest and end it as REACHED."""

    motion: int


class ConfigureArm(CommandToArm, frozen=True, kw_only=True, tag="configure"):
    """Apply validated settings."""

    settings: ControlSettings


class MeasureSeparation(CommandToArm, frozen=True, kw_only=True, tag="measure_separation"):
    """Use this measured distance for speed and separation monitoring."""

    measured: MeasuredSeparation


class RecoverArm(CommandToArm, frozen=True, kw_only=True, tag="recover"):
    """End a reflex stop."""


class HoldMotion(ControlCommand, frozen=True, kw_only=True, tag="hold"):
    """Bring a motion to rest on its path; a motion's holds and resumes are numbered from 1 by the sender."""

    motion: int
    request: int


class ResumeMotion(ControlCommand, frozen=True, kw_only=True, tag="resume"):
    """Resume a held motion."""

    motion: int
    request: int


class CancelMotion(ControlCommand, frozen=True, kw_only=True, tag="cancel"):
    """Bring a motion to rest and end it."""

    motion: int


class StopAll(ControlCommand, frozen=True, kw_only=True, tag="stop_all"):
    """Cancel every motion."""


ArmCommand = (
    FollowTrajectory
    | TrackForce
    | StartStream
    | StartGuiding
    | Setpoint
    | FinishStream
    | ConfigureArm
    | RecoverArm
    | MeasureSeparation
)
"""What the control loop of an arm takes."""

MotionCommand = HoldMotion | ResumeMotion | CancelMotion | StopAll
"""About motions of any device, by their numbers."""
