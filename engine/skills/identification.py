"""Identification of what an arm carries and of the friction of its joints; served under the arm's name."""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec

from engine.messages import Message, Vector3
from engine.skill import Action, Capability
from engine.skills.collision_options import CollisionOptions

PayloadAmplitude = Annotated[
    float,
    msgspec.Meta(
        ge=0.1, le=1.0, description="Amplitude of the wrist joints about the start", extra_json_schema={"unit": "rad"}
    ),
]
FrictionAmplitude = Annotated[
    float,
    msgspec.Meta(
        ge=0.1, le=1.0, description="Amplitude of each joint about the start", extra_json_schema={"unit": "rad"}
    ),
]


class IdentificationFeedback(Message, frozen=True, kw_only=True):
    """The present joints and the completed share of the motion."""

    joints: tuple[float, ...]
    progress: float


class PayloadEstimate(Message, frozen=True, kw_only=True):
    """What the arm carries in all, in the form of `SetLoad`: mass, centre of mass in the model's tool link.

    The uncertainties are two standard deviations. `residual_n` and `residual_nm` are what the estimate leaves of the
    measured wrench, root mean square. The centre of mass of nothing is zero, and its uncertainty without meaning.
    """

    mass_kg: float
    com_m: Vector3
    mass_uncertainty_kg: float
    com_uncertainty_m: float
    residual_n: float
    residual_nm: float
    samples: int


class JointFrictionEstimate(Message, frozen=True, kw_only=True):
    """Friction of one joint, as `robot.yaml` takes it; the uncertainties are two standard deviations.

    `residual_nm` is what the estimate leaves of the measured torque, root mean square.
    """

    joint: str
    coulomb_nm: float
    viscous_nms_rad: float
    coulomb_uncertainty_nm: float
    viscous_uncertainty_nms_rad: float
    residual_nm: float


class FrictionEstimate(Message, frozen=True, kw_only=True):
    """Friction of the joints that were moved, in the order of the arm."""

    joints: tuple[JointFrictionEstimate, ...]
    samples: int


class IdentifyPayload(Action[PayloadEstimate, IdentificationFeedback], frozen=True, kw_only=True):
    """Weigh what the tool carries: the last three joints swing about the start, and the arm ends there.

    Measures with the wrist sensor; nothing may touch the tool or the part meanwhile. The load that is set is counted
    in. Rejected before the motion where a joint has no room, or the path is not free.
    """

    capability: ClassVar[Capability] = "trajectory"

    amplitude_rad: PayloadAmplitude = 0.5
    collisions: CollisionOptions = CollisionOptions()


class IdentifyFriction(Action[FrictionEstimate, IdentificationFeedback], frozen=True, kw_only=True):
    """Measure the friction of joints: each in turn swings about the start, and the arm ends there.

    Without `joints` all of them. Measures with the torques of the motors, so that a wrong load has little effect.
    Rejected before the motion where a joint has no room, or the path is not free.
    """

    capability: ClassVar[Capability] = "trajectory"

    joints: tuple[str, ...] = ()
    amplitude_rad: FrictionAmplitude = 0.4
    collisions: CollisionOptions = CollisionOptions()
