"""The options of the driver `franka`, as a cell document writes them."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.cell.drivers import DriverOptions

Metres = Annotated[float, Meta(ge=-2.0, le=2.0)]
Radians = Annotated[float, Meta(ge=-6.3, le=6.3)]
TorqueThreshold = Annotated[float, Meta(gt=0.0, le=100.0)]
ForceThreshold = Annotated[float, Meta(gt=0.0, le=200.0)]
JointStiffness = Annotated[float, Meta(gt=0.0, le=14250.0)]

Torques = tuple[
    TorqueThreshold,
    TorqueThreshold,
    TorqueThreshold,
    TorqueThreshold,
    TorqueThreshold,
    TorqueThreshold,
    TorqueThreshold,
]
Forces = tuple[ForceThreshold, ForceThreshold, ForceThreshold, ForceThreshold, ForceThreshold, ForceThreshold]
Stiffnesses = tuple[
    JointStiffness, JointStiffness, JointStiffness, JointStiffness, JointStiffness, JointStiffness, JointStiffness
]


class FrankaOptions(DriverOptions, frozen=True, kw_only=True, tag="franka"):
    """A Franka Research 3 with its Franka Control Interface (FCI) active.

    Thresholds, stiffness, load and end effector frame are set again whenever motion is enabled. Without `tcp` the end
    effector frame has the tool centre point of the model and the orientation that is set in the web interface.
    """

    host: Annotated[str, Meta(min_length=1, description="Address of the control cabinet; its ports are fixed")]
    real_time: Annotated[
        Literal["enforce", "ignore"],
        Meta(description="enforce: refuse to move without a real-time kernel; ignore: for emulators"),
    ] = "enforce"
    contact_torque_nm: Annotated[Torques, Meta(description="Joint torques from which the robot reports a contact")] = (
        10.0, 10.0, 9.0, 9.0, 8.0, 7.0, 6.0,
    )  # fmt: skip
    reflex_torque_nm: Annotated[Torques, Meta(description="Joint torques from which the robot stops")] = (
        20.0, 20.0, 18.0, 18.0, 16.0, 14.0, 12.0,
    )  # fmt: skip
    contact_force_n: Annotated[
        Forces, Meta(description="Forces (N) and torques (N m) at the tool from which the robot reports a contact")
    ] = (10.0, 10.0, 10.0, 12.5, 12.5, 12.5)
    reflex_force_n: Annotated[
        Forces, Meta(description="Forces (N) and torques (N m) at the tool from which the robot stops")
    ] = (20.0, 20.0, 20.0, 25.0, 25.0, 25.0)
    joint_stiffness_nm_rad: Annotated[
        Stiffnesses, Meta(description="Stiffness with which the robot follows set points")
    ] = (3000.0, 3000.0, 3000.0, 2500.0, 2500.0, 2000.0, 2000.0)
    tcp: (
        Annotated[
            tuple[Metres, Metres, Metres, Radians, Radians, Radians],
            Meta(description="End effector frame at the flange: metres, then a rotation vector"),
        ]
        | None
    ) = None
    payload_kg: Annotated[
        float, Meta(ge=0.0, le=3.0, description="Mass at the flange that the robot does not know of")
    ] = 0.0
    payload_com_m: (
        Annotated[tuple[Metres, Metres, Metres], Meta(description="Its centre of mass at the flange")] | None
    ) = None
    path_tolerance_rad: Annotated[
        float, Meta(gt=0.0, le=1.0, description="How far a joint may be behind its set point")
    ] = 0.1
    stale_s: Annotated[
        float, Meta(ge=0.05, le=5.0, description="Seconds without a new measurement until the arm counts as lost")
    ] = 0.2
    process_silence_s: Annotated[
        float,
        Meta(ge=1.5, le=10.0, description="Seconds that its process may be silent; libfranka itself waits for one"),
    ] = 2.0
