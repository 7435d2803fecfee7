"""A robot controller that takes joint set points, as the loop of its control process uses it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from robots.port import Array


class ControllerFailure(Exception):
    """Base of what a controller answers instead; `hint` says what to do."""

    def __init__(self, message: str, *, hint: str = "") -> None:
        super().__init__(message)
        self.hint = hint


class ControllerLost(ControllerFailure):
    """The controller cannot be reached, or says nothing new in time; the message says which."""


class MotionRefused(ControllerFailure):
    """The controller does not move: a stop, a fault, no power, a program that ended; the message names the cause."""


@dataclass(frozen=True, kw_only=True)
class ControllerIdentity:
    """What a controller says of itself when it is connected."""

    firmware: str = ""
    serial_number: str = ""
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ControllerReading:
    """One measurement of a controller.

    Attributes:
        time_s: The controller's clock; of a controller without one, the monotonic clock at the request.
        position_rad: Measured joint angles, (n,).
        velocity_rad_s: Measured joint velocities, (n,).
        effort_nm: Joint torques, (n,); zeros where they are not measured.
        wrench: Force and torque of the environment on the tool at the tool centre point, axes of the model's base
            link, without the weight of the load that `enable` has set, (6,); None where it is not measured.
        stopped_by: Why the controller does not move, by name; empty while it can.
        remedy: What a person can do about `stopped_by`.
        speed_scaling: Share of the commanded speed that the controller permits at present, 0 to 1.
        outputs: Present values of its digital outputs.
        inputs: Present values of its digital inputs.
        periods: Periods since the last reading in which a controller that goes on by itself has continued the motion:
            the next set point is as many farther. 1 for a controller that waits for set points.
        held_rad: Set point that the controller holds, (n,), from which motion starts; None where it tells none.
    """

    time_s: float
    position_rad: Array
    velocity_rad_s: Array
    effort_nm: Array
    wrench: Array | None = None
    stopped_by: str = ""
    remedy: str = ""
    speed_scaling: float = 1.0
    outputs: tuple[bool, ...] = ()
    inputs: tuple[bool, ...] = ()
    periods: int = 1
    held_rad: Array | None = None


class JointController(Protocol):
    """Used by one thread. Every call ends within the control period or the time limit that it states."""

    @property
    def period_s(self) -> float:
        """Time between two set points."""
        ...

    def connect(self) -> ControllerIdentity:
        """Connect for reading; commands nothing.

        Raises:
            ControllerLost: it does not answer.
        """
        ...

    def enable(self, *, tcp_xyz_m: Array, load_kg: float, load_com_m: Array) -> None:
        """Set what a controller forgets (tool, payload, watchdog) and accept set points from now on, at rest.

        `tcp_xyz_m` is the tool centre point at the flange, `load_com_m` the centre of the load there; an option of the
        driver that says otherwise counts more. Called again at rest when they change. May take seconds.

        Raises:
            MotionRefused: it cannot move.
            ControllerLost: it does not answer.
        """
        ...

    def read(self) -> ControllerReading | None:
        """Wait for the next measurement, for two periods at most, and return it; None if nothing new came.

        The loop refuses readings with values that are not finite or that have another number of joints than the arm.
        The loop decides how long a controller may be silent, so that it hears STOP and the engine meanwhile.

        Raises:
            ControllerLost: the link is cut.
        """
        ...

    def command(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Send the set point of the next period, (n,).

        Raises:
            MotionRefused: it does not take set points.
            ControllerLost: the link is cut.
        """
        ...

    def stop(self) -> None:
        """Bring the arm to rest by the controller's own means, on a path of its own where there is one."""
        ...

    def set_output(self, output: int, *, on: bool) -> None:
        """Begin to set a digital output; `read` goes on with it, and its readings have the value.

        Raises:
            MotionRefused: it does not set it.
            ControllerLost: the link is cut.
        """
        ...

    @property
    def output_problem(self) -> str:
        """Why the output that was set last is not; empty where it is, or still may be."""
        ...

    def close(self) -> None:
        """End the program on the controller, if it has one, and disconnect."""
        ...
