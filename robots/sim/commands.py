"""What a simulation can be told, as messages that also cross the border to its own process."""

from __future__ import annotations

import msgspec
import numpy as np

from robots.port import Array, JointTrajectory, Tolerance


class Command(msgspec.Struct, frozen=True, kw_only=True, tag_field="command"):
    """Root of the commands; motions are numbered by the sender, from 1, never twice."""


class Follow(Command, frozen=True, kw_only=True, tag="follow"):
    """Follow a trajectory; both arrays are float64 row-major bytes of shape (samples, n)."""

    arm: str
    motion: int
    dt_s: float
    samples: int
    position: bytes
    velocity: bytes
    path_rad: float
    goal_rad: float
    settle_s: float

    @classmethod
    def of(cls, arm: str, motion: int, trajectory: JointTrajectory, tolerance: Tolerance) -> Follow:
        """Return the command to follow `trajectory`."""
        return cls(
            arm=arm,
            motion=motion,
            dt_s=trajectory.dt_s,
            samples=len(trajectory.position_rad),
            position=_to_bytes(trajectory.position_rad),
            velocity=_to_bytes(trajectory.velocity_rad_s),
            path_rad=tolerance.path_rad,
            goal_rad=tolerance.goal_rad,
            settle_s=tolerance.settle_s,
        )

    def trajectory(self) -> JointTrajectory:
        """Return the trajectory it carries."""
        return JointTrajectory(
            dt_s=self.dt_s,
            position_rad=np.frombuffer(self.position).reshape(self.samples, -1),
            velocity_rad_s=np.frombuffer(self.velocity).reshape(self.samples, -1),
        )

    def tolerance(self) -> Tolerance:
        """Return the tolerance it carries."""
        return Tolerance(path_rad=self.path_rad, goal_rad=self.goal_rad, settle_s=self.settle_s)


class CloseTo(Command, frozen=True, kw_only=True, tag="close_to"):
    """Move the fingers of `arm` towards an opening, pressing with at most `force_n`."""

    arm: str
    motion: int
    width_m: float
    speed_m_s: float
    force_n: float


class Hold(Command, frozen=True, kw_only=True, tag="hold"):
    """Bring a motion to rest on its path; a motion's holds and resumes are numbered from 1 by the sender."""

    motion: int
    request: int


class Resume(Command, frozen=True, kw_only=True, tag="resume"):
    """Let a held motion go on."""

    motion: int
    request: int


class Cancel(Command, frozen=True, kw_only=True, tag="cancel"):
    """Bring a motion to rest and end it."""

    motion: int


class StopAll(Command, frozen=True, kw_only=True, tag="stop_all"):
    """Cancel every motion."""


class ResetParts(Command, frozen=True, kw_only=True, tag="reset_parts"):
    """Put the free parts back where the scene has them, at rest."""


class Restore(Command, frozen=True, kw_only=True, tag="restore"):
    """Go to where an image of this world was made, at rest; `numbers` are float64 as in `ImageLayout`."""

    numbers: bytes

    @classmethod
    def of(cls, image: Array) -> Restore:
        """Return the command to go to `image`."""
        return cls(numbers=_to_bytes(image))

    def image(self) -> Array:
        """Return the image it carries."""
        return np.frombuffer(self.numbers)


class Shutdown(Command, frozen=True, kw_only=True, tag="shutdown"):
    """Bring everything to rest, then end the world's process."""


AnyCommand = Follow | CloseTo | Hold | Resume | Cancel | StopAll | ResetParts | Restore | Shutdown


def _to_bytes(values: Array) -> bytes:
    return np.ascontiguousarray(values, dtype=np.float64).tobytes()
