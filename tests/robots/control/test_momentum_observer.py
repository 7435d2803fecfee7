"""The momentum observer against closed forms: a known push, the textbook integral, a motion, what the model lacks."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from robots.control.momentum_observer import OBSERVER_GAIN_1_S, MomentumObserver
from robots.model.mechanics.dynamics import ArmDynamics
from robots.model.mechanics.pinocchio_model import arm_model, pin
from robots.model.registry import model_by_name
from robots.port import Array

STEP_S = 0.001
PANDA = model_by_name("panda")
HOME = np.array(PANDA.home_rad)
PUSH_NM = np.array([5.0, -8.0, 3.0, 6.0, -1.0, 0.5, 0.2])


class FreeArm:
    """A Panda without MuJoCo: semi-implicit integration of pinocchio's forward dynamics, which the observer lacks.

    Args:
        torque_nm: Commanded torque as a function of time and the joint velocities.
        external_nm: What pushes, as a function of the same.
        gain_1_s: Gain of the observer.
    """

    def __init__(
        self,
        torque_nm: Callable[[float, Array], Array],
        external_nm: Callable[[float, Array], Array],
        *,
        gain_1_s: float = OBSERVER_GAIN_1_S,
        step_s: float = STEP_S,
    ) -> None:
        self.dynamics = ArmDynamics(PANDA)
        self.observer = MomentumObserver(PANDA.dof, gain_1_s=gain_1_s)
        self.q, self.v, self.time_s = HOME.copy(), np.zeros(PANDA.dof), 0.0
        self.torque_nm = torque_nm
        self.external_nm = external_nm
        self.step_s = step_s

    def step(self) -> None:
        """Command, integrate and observe one period."""
        mass, bias = self.dynamics.mass_matrix(self.q), self.dynamics.bias(self.q, self.v)
        torque = bias + self.torque_nm(self.time_s, self.v)
        self.observer.command(torque, velocity=self.v, mass_matrix=mass, bias_nm=bias)
        total = torque + self.external_nm(self.time_s, self.v) - bias
        self.v = self.v + self.step_s * np.linalg.solve(mass, total)
        self.q = self.q + self.step_s * self.v
        self.time_s += self.step_s
        self.observer.measure(self.v, load_nm=None, step_s=self.step_s)


def nothing(_time_s: float, velocity: Array) -> Array:
    """Exert no torque."""
    return np.zeros_like(velocity)


def swing(time_s: float, velocity: Array) -> Array:
    """Move all joints to and fro, up to about 1 rad/s."""
    return 8.0 * np.cos(6.0 * time_s) * np.array([1.0, 1.0, 1.0, 1.0, 0.3, 0.3, 0.2]) - 0.5 * velocity


def test_a_constant_push_is_estimated_with_the_time_constant_of_the_gain() -> None:
    """The estimate of a step is the step times 1 - exp(-K t), to 1e-9, in every joint; it is never beyond."""
    arm = FreeArm(lambda _t, v: -40.0 * v, lambda _t, _v: PUSH_NM)
    for steps in range(1, 31):
        arm.step()
        share = 1.0 - np.exp(-OBSERVER_GAIN_1_S * steps * STEP_S)
        assert arm.observer.external_nm == pytest.approx(share * PUSH_NM, abs=1e-9)


def test_an_arm_that_matches_its_model_feels_nothing_in_motion() -> None:
    arm, most_nm, fastest = FreeArm(swing, nothing), 0.0, 0.0
    for _ in range(2000):
        arm.step()
        most_nm = max(most_nm, float(np.abs(arm.observer.external_nm).max()))
        fastest = max(fastest, float(np.abs(arm.v).max()))
    assert fastest > 1.0
    assert most_nm < 1e-9


def test_it_is_the_observer_of_the_textbook() -> None:
    """r = K (p - int(tau + C^T v - g + r)) with pinocchio's Coriolis matrix, sampled at 20 kHz, is within 1 %."""
    step_s, gain = 5e-5, 50.0
    arm = FreeArm(swing, lambda t, _v: PUSH_NM * np.sin(9.0 * t), gain_1_s=gain, step_s=step_s)
    solver = arm_model(PANDA)
    solver.armature = np.array(PANDA.armature_kg_m2)
    data = solver.createData()
    integral, residual, off, most = np.zeros(PANDA.dof), np.zeros(PANDA.dof), 0.0, 0.0
    for _ in range(10000):
        q, v = arm.q.copy(), arm.v.copy()
        coriolis = pin.computeCoriolisMatrix(solver, data, q, v).copy()
        gravity = pin.computeGeneralizedGravity(solver, data, q).copy()
        torque = arm.dynamics.bias(q, v) + swing(arm.time_s, v)
        arm.step()
        integral += step_s * (torque + coriolis.T @ v - gravity + residual)
        residual = gain * (arm.dynamics.mass_matrix(arm.q) @ arm.v - integral)
        off = max(off, float(np.abs(residual - arm.observer.external_nm).max()))
        most = max(most, float(np.abs(residual).max()))
    assert most > 5.0
    assert off < 0.01 * most


def test_friction_that_the_model_lacks_is_taken_for_an_external_torque() -> None:
    """What an observer cannot tell apart from a push: 1 N m against the motion is estimated as just that."""
    friction = 1.0
    arm = FreeArm(
        lambda _t, v: np.full(PANDA.dof, 2.0) - 2.0 * v, lambda _t, v: -friction * np.sign(np.where(v > 1e-3, v, 0.0))
    )
    for _ in range(300):
        arm.step()
    assert arm.v.min() > 0.05
    assert arm.observer.external_nm == pytest.approx(np.full(PANDA.dof, -friction), abs=1e-6)


def test_noise_of_the_velocities_is_amplified_by_gain_and_inertia() -> None:
    """A tenth of the gain passes less than a fifth of the noise; at rest its mean is zero."""

    def spread_nm(gain_1_s: float) -> tuple[float, float]:
        random, arm = np.random.default_rng(3), FreeArm(nothing, nothing, gain_1_s=gain_1_s)
        mass, bias = arm.dynamics.mass_matrix(HOME), arm.dynamics.bias(HOME, arm.v)
        found: list[float] = []
        before = np.zeros(PANDA.dof)
        for _ in range(4000):
            velocity = random.normal(0.0, 1e-3, PANDA.dof)
            arm.observer.command(bias, velocity=before, mass_matrix=mass, bias_nm=bias)
            arm.observer.measure(velocity, load_nm=None, step_s=STEP_S)
            before = velocity
            found.append(float(arm.observer.external_nm[0]))
        return float(np.std(found)), float(np.mean(found))

    (wide, mean), (narrow, _) = spread_nm(OBSERVER_GAIN_1_S), spread_nm(0.1 * OBSERVER_GAIN_1_S)
    assert 0.05 < wide < 1.0
    assert abs(mean) < 0.01
    assert narrow < wide / 5.0


def test_after_forgetting_it_starts_from_zero() -> None:
    arm = FreeArm(nothing, lambda _t, _v: PUSH_NM)
    for _ in range(20):
        arm.step()
    arm.observer.forget()
    arm.observer.measure(arm.v + 1.0, load_nm=None, step_s=STEP_S)
    assert arm.observer.external_nm.tolist() == [0.0] * PANDA.dof
