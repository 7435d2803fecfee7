"""Sensors and motors with errors: quantized, noisy as said, late by whole steps, and the same at every call."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robots.scene.realism import IDEAL, Realism, realism
from robots.sim.loop.arm_hardware import ArmHardware, arm_hardware
from tests.robots.sim.sim_cell import HOME, PANDA

TYPICAL = realism("typical")
REST = np.zeros(PANDA.dof)
EFFORT_NM = np.array(PANDA.limits.effort_nm)
STEPS = 5000


def new_hardware(errors: Realism = TYPICAL, *, name: str = "left", seed: int = 0) -> ArmHardware:
    """Return the hardware of a Panda."""
    return arm_hardware(name, limits=PANDA.limits, realism=errors, seed=seed, step_s=0.001)


def test_ideal_hardware_passes_everything_on() -> None:
    hardware = new_hardware(IDEAL)
    position, velocity = hardware.joints(HOME, REST + 0.1, step=4)
    assert (position.tolist(), velocity.tolist()) == (HOME.tolist(), (REST + 0.1).tolist())
    assert hardware.drive(EFFORT_NM).tolist() == EFFORT_NM.tolist()
    assert hardware.effort(EFFORT_NM, step=4).tolist() == EFFORT_NM.tolist()
    assert hardware.wrench(np.arange(6.0), axes=np.eye(3), step=4).tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]


def test_positions_are_whole_counts_of_the_encoder_near_the_true_ones() -> None:
    hardware, quantum = new_hardware(), 2.0 * math.pi / 2**19
    measured = np.array([hardware.joints(HOME, REST, step=step)[0] for step in range(STEPS)])
    counts = measured / quantum
    assert np.abs(counts - np.rint(counts)).max() < 1e-6
    assert np.abs(measured - HOME).max() < quantum / 2.0 + 5.0 * TYPICAL.encoder_noise_rad
    assert len(set(measured[:, 0].tolist())) > 1


def test_noise_has_the_spread_of_the_preset_and_no_mean() -> None:
    hardware = new_hardware()
    velocities = np.array([hardware.joints(HOME, REST, step=step)[1] for step in range(STEPS)])
    efforts = np.array([hardware.effort(REST, step=step) for step in range(STEPS)])
    wrenches = np.array([hardware.wrench(np.zeros(6), axes=np.eye(3), step=step) for step in range(STEPS)])
    assert velocities.std(axis=0) == pytest.approx(np.full(7, TYPICAL.velocity_noise_rad_s), rel=0.06)
    assert efforts.std(axis=0) == pytest.approx(TYPICAL.torque_noise_share * EFFORT_NM, rel=0.06)
    spread = np.repeat((TYPICAL.force_noise_n, TYPICAL.moment_noise_nm), 3)
    assert wrenches.std(axis=0) == pytest.approx(spread, rel=0.06)
    assert np.abs(velocities.mean(axis=0)).max() < 0.1 * TYPICAL.velocity_noise_rad_s
    offset = np.abs(wrenches.mean(axis=0))
    assert (offset < np.repeat((TYPICAL.force_offset_n, TYPICAL.moment_offset_nm), 3) + 0.1 * spread).all()
    assert offset[:3].max() > 0.02


def test_noise_depends_on_seed_arm_and_step_only() -> None:
    """A world that continues from a checkpoint measures what it would have measured."""

    def velocities(hardware: ArmHardware, steps: list[int]) -> list[list[float]]:
        return [hardware.joints(HOME, REST, step=step)[1].tolist() for step in steps]

    there = [2000, 0, 1023, 1024, 5, 2000]
    forth = velocities(new_hardware(), there)
    assert forth == velocities(new_hardware(), there[::-1])[::-1]
    assert forth[0] == forth[-1] != forth[1]
    assert forth != velocities(new_hardware(seed=1), there)
    assert forth != velocities(new_hardware(name="right"), there)


def test_torques_act_after_the_delay_and_the_first_one_at_once() -> None:
    hardware = new_hardware(realism("poor"))
    acting = [float(hardware.drive(np.full(7, float(n)))[0]) for n in range(6)]
    assert acting == [0.0, 0.0, 0.0, 1.0, 2.0, 3.0]
    hardware.forget()
    assert float(hardware.drive(np.full(7, 9.0))[0]) == 9.0
