"""What stands between the control loop of a simulated arm and its physics: encoders, motors and a wrist sensor."""

from __future__ import annotations

import zlib
from collections import deque
from typing import Protocol

import numpy as np

from robots.model.robot_model import JointLimits
from robots.port import Array
from robots.scene.realism import IDEAL, Realism

# Noise is drawn in blocks, each from a stream of its own: a value depends on the seed and the step only, so that a
# restored world continues with the same noise.
_BLOCK_STEPS = 1024


class ArmHardware(Protocol):
    """Reads the sensors of an arm and drives its motors; `step` is the number of the step that begins."""

    def joints(self, position: Array, velocity: Array, *, step: int) -> tuple[Array, Array]:
        """Return the measured joint positions and velocities, (n,)."""
        ...

    def wrench(self, wrench: Array, *, axes: Array, step: int) -> Array:
        """Return the measured force and torque at the tool, (6,); `axes` (3, 3) are the sensor's in the world."""
        ...

    def effort(self, torque_nm: Array, *, step: int) -> Array:
        """Return the measured motor torques, (n,)."""
        ...

    def drive(self, torque_nm: Array) -> Array:
        """Return the torques that act in this step, when these are commanded, (n,)."""
        ...

    def forget(self) -> None:
        """Drop pending commands: the arm was moved elsewhere."""
        ...


class IdealHardware:
    """Implements `ArmHardware` without errors."""

    def joints(self, position: Array, velocity: Array, *, step: int) -> tuple[Array, Array]:
        """Return them as they are."""
        return position, velocity

    def wrench(self, wrench: Array, *, axes: Array, step: int) -> Array:
        """Return it as it is."""
        return wrench

    def effort(self, torque_nm: Array, *, step: int) -> Array:
        """Return them as they are."""
        return torque_nm

    def drive(self, torque_nm: Array) -> Array:
        """Return them as they are."""
        return torque_nm

    def forget(self) -> None:
        """Nothing is pending."""


class ErroneousHardware:
    """Implements `ArmHardware` with noise, offsets, quantization and delay.

    Args:
        name: Name of the arm.
        limits: Limits of its joints.
        realism: The errors.
        seed: Seed of the run.
        step_s: Duration of a step.
    """

    def __init__(self, name: str, *, limits: JointLimits, realism: Realism, seed: int, step_s: float) -> None:
        self._seed = (seed, zlib.crc32(f"{name}/hardware".encode()))
        n = len(limits.effort_nm)
        self._quantum_rad = realism.encoder_resolution_rad
        self._position, self._velocity = slice(0, n), slice(n, 2 * n)
        self._effort, self._wrench = slice(2 * n, 3 * n), slice(3 * n, 3 * n + 6)
        spread = np.zeros(3 * n + 6)
        spread[self._position] = realism.encoder_noise_rad
        spread[self._velocity] = realism.velocity_noise_rad_s
        spread[self._effort] = realism.torque_noise_share * np.array(limits.effort_nm)
        spread[self._wrench] = np.repeat((realism.force_noise_n, realism.moment_noise_nm), 3)
        self._spread = spread
        offsets = np.random.default_rng(self._seed).uniform(-1.0, 1.0, 6)
        self._offset = offsets * np.repeat((realism.force_offset_n, realism.moment_offset_nm), 3)
        self._block, self._noise = -1, np.zeros((0, len(spread)))
        self._pending: deque[Array] = deque()
        self._delay_steps = round(realism.actuation_delay_s / step_s)

    def joints(self, position: Array, velocity: Array, *, step: int) -> tuple[Array, Array]:
        """Return the measured joint positions and velocities, (n,)."""
        noise = self._noise_of(step)
        counts = np.rint((position + noise[self._position]) / self._quantum_rad)
        return counts * self._quantum_rad, velocity + noise[self._velocity]

    def wrench(self, wrench: Array, *, axes: Array, step: int) -> Array:
        """Return the measured force and torque at the tool, (6,); the offset turns with the sensor."""
        offset = (self._offset.reshape(2, 3) @ axes.T).reshape(6)
        return wrench + offset + self._noise_of(step)[self._wrench]

    def effort(self, torque_nm: Array, *, step: int) -> Array:
        """Return the measured motor torques, (n,)."""
        return torque_nm + self._noise_of(step)[self._effort]

    def drive(self, torque_nm: Array) -> Array:
        """Return the torques commanded so many steps ago; the first ones act at once."""
        pending = self._pending
        pending.append(torque_nm.copy())
        return pending.popleft() if len(pending) > self._delay_steps else pending[0]

    def forget(self) -> None:
        """Drop pending commands."""
        self._pending.clear()

    def _noise_of(self, step: int) -> Array:
        block, row = divmod(step, _BLOCK_STEPS)
        if block != self._block:
            stream = np.random.default_rng((*self._seed, block + 1))
            self._noise = stream.standard_normal((_BLOCK_STEPS, len(self._spread))) * self._spread
            self._block = block
        return self._noise[row]


def arm_hardware(name: str, *, limits: JointLimits, realism: Realism, seed: int, step_s: float) -> ArmHardware:
    """Return the hardware of an arm."""
    if realism == IDEAL:
        return IdealHardware()
    return ErroneousHardware(name, limits=limits, realism=realism, seed=seed, step_s=step_s)
