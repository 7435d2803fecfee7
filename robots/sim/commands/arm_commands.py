"""Commands to one arm of a simulation, as messages that can also be sent to its own process."""

from __future__ import annotations

import msgspec
import numpy as np

from engine.messages import Quaternion, Vector3
from robots.port import (
    Admittance,
    ArmSettings,
    Array,
    ContactCondition,
    ForceTask,
    JointTrajectory,
    StreamKind,
    Tolerance,
)


class SimCommand(msgspec.Struct, frozen=True, kw_only=True, tag_field="command"):
    """Base of the commands; the sender numbers motions from 1, each number once."""


class CommandToArm(SimCommand, frozen=True, kw_only=True):
    """Base of the commands to one arm."""

    arm: str


class EncodedTrajectory(msgspec.Struct, frozen=True, kw_only=True):
    """A trajectory as bytes: float64 row-major, shape (samples, n)."""

    dt_s: float
    samples: int
    position: bytes
    velocity: bytes

    @classmethod
    def of(cls, trajectory: JointTrajectory) -> EncodedTrajectory:
        """Return `trajectory` as bytes."""
        return cls(
            dt_s=trajectory.dt_s,
            samples=len(trajectory.position_rad),
            position=to_bytes(trajectory.position_rad),
            velocity=to_bytes(trajectory.velocity_rad_s),
        )

    def trajectory(self) -> JointTrajectory:
        """Return the trajectory."""
        return JointTrajectory(
            dt_s=self.dt_s,
            position_rad=np.frombuffer(self.position).reshape(self.samples, -1),
            velocity_rad_s=np.frombuffer(self.velocity).reshape(self.samples, -1),
        )


class EncodedTolerance(msgspec.Struct, frozen=True, kw_only=True):
    """A tolerance as a message."""

    path_rad: float
    goal_rad: float
    settle_s: float

    @classmethod
    def of(cls, tolerance: Tolerance) -> EncodedTolerance:
        """Return `tolerance` as a message."""
        return cls(path_rad=tolerance.path_rad, goal_rad=tolerance.goal_rad, settle_s=tolerance.settle_s)

    def tolerance(self) -> Tolerance:
        """Return the tolerance."""
        return Tolerance(path_rad=self.path_rad, goal_rad=self.goal_rad, settle_s=self.settle_s)


class FollowTrajectory(CommandToArm, frozen=True, kw_only=True, tag="follow"):
    """Follow a trajectory, ended by a contact of `contact_n` along `contact_direction` if `contact_n` is above 0."""

    motion: int
    way: EncodedTrajectory
    closeness: EncodedTolerance
    contact_n: float = 0.0
    contact_direction: Vector3 = (0.0, 0.0, 0.0)

    @classmethod
    def of(
        cls,
        arm: str,
        motion: int,
        trajectory: JointTrajectory,
        tolerance: Tolerance,
        until: ContactCondition | None = None,
    ) -> FollowTrajectory:
        """Return the command to follow `trajectory`."""
        return cls(
            arm=arm,
            motion=motion,
            way=EncodedTrajectory.of(trajectory),
            closeness=EncodedTolerance.of(tolerance),
            contact_n=until.force_n if until is not None else 0.0,
            contact_direction=until.direction if until is not None else (0.0, 0.0, 0.0),
        )

    def contact(self) -> ContactCondition | None:
        """Return the contact condition that ends it, if any."""
        return (
            ContactCondition(force_n=self.contact_n, direction=self.contact_direction) if self.contact_n > 0.0 else None
        )


class TrackForce(CommandToArm, frozen=True, kw_only=True, tag="track_force"):
    """Follow a tool path under force control; `offset` and `wrench` are float64 row-major bytes, shape (samples, 6)."""

    motion: int
    way: EncodedTrajectory
    closeness: EncodedTolerance
    offset: bytes
    wrench: bytes
    task_xyzw: Quaternion
    admittance: Admittance
    slow_per_n: float
    record_s: float

    @classmethod
    def of(cls, arm: str, motion: int, task: ForceTask, tolerance: Tolerance) -> TrackForce:
        """Return the command to execute `task`."""
        return cls(
            arm=arm,
            motion=motion,
            way=EncodedTrajectory.of(task.trajectory),
            closeness=EncodedTolerance.of(tolerance),
            offset=to_bytes(task.offset),
            wrench=to_bytes(task.wrench),
            task_xyzw=task.task_xyzw,
            admittance=task.admittance,
            slow_per_n=task.slow_per_n,
            record_s=task.record_s,
        )

    def task(self) -> ForceTask:
        """Return the task."""
        return ForceTask(
            trajectory=self.way.trajectory(),
            offset=np.frombuffer(self.offset).reshape(-1, 6),
            wrench=np.frombuffer(self.wrench).reshape(-1, 6),
            task_xyzw=self.task_xyzw,
            admittance=self.admittance,
            slow_per_n=self.slow_per_n,
            record_s=self.record_s,
        )


class StartStream(CommandToArm, frozen=True, kw_only=True, tag="listen"):
    """Follow the `Setpoint` commands until `FinishStream` or `CancelMotion`."""

    motion: int
    kind: StreamKind
    watchdog_s: float


class StartGuiding(CommandToArm, frozen=True, kw_only=True, tag="float"):
    """Start guiding by hand, with this share of the joint damping, until `FinishStream` or `CancelMotion`."""

    motion: int
    damping: float


class Setpoint(CommandToArm, frozen=True, kw_only=True, tag="tell"):
    """Target positions or velocities of a stream, sent `age_s` ago."""

    motion: int
    values: tuple[float, ...]
    age_s: float = 0.0


class FinishStream(CommandToArm, frozen=True, kw_only=True, tag="finish"):
    """Bring a stream to rest and end it as REACHED."""

    motion: int


class ConfigureArm(CommandToArm, frozen=True, kw_only=True, tag="configure"):
    """Apply validated settings."""

    settings: ArmSettings


class RecoverArm(CommandToArm, frozen=True, kw_only=True, tag="recover"):
    """End a reflex stop."""


ArmCommand = (
    FollowTrajectory | TrackForce | StartStream | StartGuiding | Setpoint | FinishStream | ConfigureArm | RecoverArm
)


def to_bytes(values: Array) -> bytes:
    """Return float64 row-major bytes."""
    return np.ascontiguousarray(values, dtype=np.float64).tobytes()
