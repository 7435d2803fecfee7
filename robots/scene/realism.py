"""How far simulated arms differ from their nominal models: presets of errors, in SI units.

Shares of torques refer to the effort limit of each joint, so that one preset fits small and large arms. Figures without
a source are assumptions of the usual magnitude; decision 0072 says what each one is for.

- Gaz et al., Dynamic Identification of the Franka Emika Panda Robot, RA-L 2019: friction of a Panda saturates at half
  of 0.30 to 1.28 N m, 0.3 to 0.7 % of the limit of the large joints and 1.3 to 3.5 % of that of the small ones.
- Drake, README of `franka_description`: reflected motor inertias of 0.21 to 0.61 kg m².
- Wrist sensor: noise of 0.15 N, as in this project's experiments with force control.
- Encoders: 19 and 17 bits a turn at the joint, 12 and 48 µrad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from engine.document import RealismName


@dataclass(frozen=True, kw_only=True)
class Realism:
    """Errors of simulated arms; without any the plant is what the controllers know, up to the joints of tools.

    `…_spread` and `…_m`, `…_rad` of links and bases limit a uniform draw in both directions, one per run. Noise is
    Gaussian with this standard deviation in every step.
    """

    coulomb_share: float = 0.0
    """Coulomb friction of each joint, share of its effort limit."""
    viscous_share_s_rad: float = 0.0
    """Viscous friction of each joint at 1 rad/s, share of its effort limit."""
    friction_spread: float = 0.0
    """Spread of both from joint to joint, share."""
    motor_inertia_spread: float = 0.0
    """Spread of the reflected motor inertia, share."""
    actuation_delay_s: float = 0.0
    """Time until a commanded torque acts; rounded to steps."""
    link_mass_spread: float = 0.0
    """Spread of the masses of links and tools, share."""
    link_com_m: float = 0.0
    """Spread of the centre of mass of each link along each of its axes."""
    payload_spread: float = 0.0
    """Spread of the masses of parts, share: what is set as load is not what is carried."""
    base_m: float = 0.0
    """Spread of the position of each base along each axis."""
    base_rad: float = 0.0
    """Spread of the rotation of each base about each axis."""
    encoder_resolution_rad: float = 0.0
    """Quantum of measured joint positions."""
    encoder_noise_rad: float = 0.0
    """Noise of measured joint positions, before quantization."""
    velocity_noise_rad_s: float = 0.0
    """Noise of measured joint velocities: encoder steps through the filter of a drive."""
    torque_noise_share: float = 0.0
    """Noise of measured motor torques, share of the effort limit."""
    force_noise_n: float = 0.0
    """Noise of measured forces at the tool, each axis."""
    force_offset_n: float = 0.0
    """Spread of the offset of measured forces that taring leaves, each axis."""
    moment_noise_nm: float = 0.0
    """Noise of measured torques at the tool, each axis."""
    moment_offset_nm: float = 0.0
    """Spread of the offset of measured torques at the tool, each axis."""


IDEAL = Realism()

_PRESETS: dict[RealismName, Realism] = {
    "ideal": IDEAL,
    "typical": Realism(
        coulomb_share=0.01,
        viscous_share_s_rad=0.005,
        friction_spread=0.3,
        motor_inertia_spread=0.1,
        actuation_delay_s=0.001,
        link_mass_spread=0.02,
        link_com_m=0.002,
        payload_spread=0.03,
        base_m=0.0003,
        base_rad=0.0003,
        encoder_resolution_rad=2.0 * math.pi / 2**19,
        encoder_noise_rad=5e-6,
        velocity_noise_rad_s=0.0005,
        torque_noise_share=0.001,
        force_noise_n=0.15,
        force_offset_n=0.2,
        moment_noise_nm=0.005,
        moment_offset_nm=0.01,
    ),
    "poor": Realism(
        coulomb_share=0.03,
        viscous_share_s_rad=0.02,
        friction_spread=0.5,
        motor_inertia_spread=0.25,
        actuation_delay_s=0.002,
        link_mass_spread=0.05,
        link_com_m=0.005,
        payload_spread=0.1,
        base_m=0.001,
        base_rad=0.001,
        encoder_resolution_rad=2.0 * math.pi / 2**17,
        encoder_noise_rad=2e-5,
        velocity_noise_rad_s=0.002,
        torque_noise_share=0.005,
        force_noise_n=0.5,
        force_offset_n=1.0,
        moment_noise_nm=0.02,
        moment_offset_nm=0.05,
    ),
}


def realism(name: RealismName) -> Realism:
    """Return a preset."""
    return _PRESETS[name]
