"""The thresholds of the collision reflex: what exceeds them, what is said of it, and when it is armed again."""

from __future__ import annotations

import pytest

from engine.skills.arm_control import ControlSettings
from robots.control.arm_state import ArmState
from robots.control.collision_reflex import CollisionReflex
from tests.robots.panda_arm import panda_kinematics, panda_model

TORQUES_NM = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0)


class FeltArm:
    """An arm of which a test says what it feels."""

    def __init__(self, settings: ControlSettings, *, touching: str = "") -> None:
        self.reflex = CollisionReflex(joints=panda_model().arm_joints, touching=lambda: touching)
        self.reflex.watch(settings)
        self._state = ArmState(panda_kinematics())

    def trips(
        self,
        *,
        torque_nm: tuple[float, ...] = (0.0,) * 7,
        force_n: tuple[float, float, float] = (0.0, 0.0, 0.0),
        moment_nm: float = 0.0,
    ) -> bool:
        """Return whether the reflex trips with these external torques and this wrench."""
        self._state.external_nm[:] = torque_nm
        self._state.wrench[:] = (*force_n, moment_nm, 0.0, 0.0)
        return self.reflex.trips(self._state)


def test_before_it_has_settings_it_never_trips() -> None:
    state = ArmState(panda_kinematics())
    state.wrench[:] = 1e6
    reflex = CollisionReflex(joints=panda_model().arm_joints, touching=lambda: "")
    assert not reflex.trips(state)
    assert reflex.reason == ""


def test_an_arm_without_thresholds_never_trips() -> None:
    arm = FeltArm(ControlSettings())
    assert not arm.trips(torque_nm=(1e6,) * 7, force_n=(1e6, 0.0, 0.0))
    assert arm.reflex.reason == ""


def test_the_joint_that_exceeds_its_own_threshold_most_is_named() -> None:
    arm = FeltArm(ControlSettings(collision_torque_nm=TORQUES_NM))
    assert not arm.trips(torque_nm=tuple(-one for one in TORQUES_NM))
    assert arm.trips(torque_nm=(10.5, 0.0, -33.0, 0.0, 0.0, 0.0, 0.0))
    assert arm.reflex.reason == "external torque limit exceeded: 33.0 N m > 30 N m on panda_joint3"


def test_the_length_of_the_force_counts_and_the_moment_does_not() -> None:
    arm = FeltArm(ControlSettings(collision_force_n=7.0))
    assert not arm.trips(force_n=(2.0, -3.0, 6.0), moment_nm=100.0)
    assert arm.trips(force_n=(2.0, -3.0, 6.1))
    assert arm.reflex.reason == "external force limit exceeded: 7.1 N > 7 N at the tool"


@pytest.mark.parametrize(
    ("settings", "is_tripped"),
    [(ControlSettings(collision_force_n=5.0), False), (ControlSettings(collision_torque_nm=TORQUES_NM), True)],
)
def test_one_kind_of_threshold_does_not_need_the_other(settings: ControlSettings, is_tripped: bool) -> None:
    arm = FeltArm(settings)
    assert arm.trips(torque_nm=(1e3,) * 7) is is_tripped
    assert FeltArm(settings).trips(force_n=(1e3, 0.0, 0.0)) is not is_tripped


def test_with_both_exceeded_the_torque_is_named() -> None:
    arm = FeltArm(ControlSettings(collision_torque_nm=TORQUES_NM, collision_force_n=5.0))
    assert arm.trips(torque_nm=(11.0, *(0.0,) * 6), force_n=(6.0, 0.0, 0.0))
    assert "torque" in arm.reflex.reason


def test_what_it_touches_is_said_too() -> None:
    arm = FeltArm(ControlSettings(collision_force_n=5.0), touching="left/hand touches table")
    arm.trips(force_n=(6.0, 0.0, 0.0))
    assert arm.reflex.reason.endswith("at the tool; left/hand touches table")


def test_it_trips_once_until_it_is_armed_again() -> None:
    arm = FeltArm(ControlSettings(collision_force_n=5.0))
    assert arm.trips(force_n=(6.0, 0.0, 0.0))
    assert not arm.trips(force_n=(9.0, 0.0, 0.0))
    assert "6.0 N" in arm.reflex.reason
    arm.reflex.reason = ""
    assert arm.trips(force_n=(9.0, 0.0, 0.0))


def test_thresholds_that_are_taken_back_no_longer_count() -> None:
    arm = FeltArm(ControlSettings(collision_torque_nm=TORQUES_NM, collision_force_n=5.0))
    arm.reflex.watch(ControlSettings(collision_force_n=50.0))
    assert not arm.trips(torque_nm=(1e3,) * 7, force_n=(6.0, 0.0, 0.0))
    arm.reflex.watch(ControlSettings())
    assert not arm.trips(force_n=(60.0, 0.0, 0.0))
