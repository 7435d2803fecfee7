"""Motion begins where the arm is measured when it is enabled: one reading that cannot be is no place to begin."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from robots.drivers.arm.joint_controller import ControllerReading, MotionRefused
from robots.port import Array
from tests.robots.drivers.arm.test_controller_loop import Arm, ControllerInMemory
from tests.robots.drivers.arm_under_test import START


class ElsewhereWhenEnabled(ControllerInMemory):
    """Its reading after the enabling is off."""

    off_rad: float = 0.0

    def enable(self, *, tcp_xyz_m: Array, load_kg: float, load_com_m: Array) -> None:
        super().enable(tcp_xyz_m=tcp_xyz_m, load_kg=load_kg, load_com_m=load_com_m)
        position = START + np.array((0.0, 0.0, self.off_rad, 0.0, 0.0, 0.0))
        self.invalid = {"position_rad": position} if self.off_rad else {}


@pytest.mark.parametrize("off_rad", [0.15, -2.0, 1e300])
def test_an_arm_that_is_measured_elsewhere_is_not_enabled_and_gets_no_set_point(off_rad: float) -> None:
    controller = ElsewhereWhenEnabled()
    loop = Arm(controller).loop
    controller.off_rad = off_rad
    with pytest.raises(MotionRefused, match=r"elbow_joint is measured .* rad from where it rested before") as refused:
        loop.enable()
    assert "enable it again" in refused.value.hint
    assert controller.sent == []


def test_a_joint_that_sags_when_its_brake_is_released_does_not_matter() -> None:
    controller = ElsewhereWhenEnabled()
    loop = Arm(controller).loop
    controller.off_rad = 0.05
    loop.enable()
    assert loop.problem == ""


class WrongOnceWhenEnabled(ControllerInMemory):
    """One of its readings after the enabling is off by less than what is refused; so is what it says it holds."""

    wrong: int | None = None

    def enable(self, *, tcp_xyz_m: Array, load_kg: float, load_com_m: Array) -> None:
        super().enable(tcp_xyz_m=tcp_xyz_m, load_kg=load_kg, load_com_m=load_com_m)
        self.wrong = 2

    def read(self) -> ControllerReading | None:
        reading = super().read()
        assert reading is not None
        if self.wrong is None:
            return reading
        self.wrong -= 1
        off_rad = 0.09 if self.wrong == 0 else 0.0
        return replace(reading, position_rad=reading.position_rad + off_rad, held_rad=START + off_rad)


def test_one_wrong_reading_is_not_where_motion_begins() -> None:
    arm = Arm(WrongOnceWhenEnabled())
    arm.loop.enable()
    arm.step(1)
    assert arm.controller.sent[-1] == pytest.approx(START)


def test_a_set_point_to_which_no_motion_leads_is_not_sent() -> None:
    """Whatever made it: the controller would go there as fast as it can."""
    arm = Arm()
    arm.loop.enable()
    arm.step(2)
    sent = len(arm.controller.sent)
    arm.loop.control.initialize(START + np.array((0.0, 0.0, 0.3, 0.0, 0.0, 0.0)))
    arm.step(3)
    assert len(arm.controller.sent) == sent
    assert arm.controller.stops == 1
    assert arm.loop.problem == "the next set point of elbow_joint is 0.3 rad away from the last"
    arm.loop.enable()
    arm.step(1)
    assert arm.controller.sent[-1] == pytest.approx(START)
