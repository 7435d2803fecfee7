"""A tool that is set again at rest, without a person: a robot that has stopped meanwhile is not recovered."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from robots.drivers.arm.joint_controller import MotionRefused
from robots.drivers.franka.franka_joint_controller import FrankaJointController
from robots.drivers.franka.franka_options import FrankaOptions
from robots.drivers.franka.franka_tool import IDENTITY

REFLEX, IDLE = 4, 1


class RobotInMemory:
    """A robot as `pylibfranka` has it, at rest; it has a reflex when its motion is finished, where it is to."""

    def __init__(self) -> None:
        self.mode = IDLE
        self.recoveries = self.starts = 0
        self.has_reflex_at_end = False

    def read_once(self) -> Any:
        return SimpleNamespace(
            time=SimpleNamespace(to_sec=lambda: 0.0),
            q=[0.0] * 7, q_d=[0.0] * 7, dq=[0.0] * 7, tau_J=[0.0] * 7, O_F_ext_hat_K=[0.0] * 6, F_T_NE=list(IDENTITY),
            robot_mode=self.mode,
            current_errors='["joint_reflex"]' if self.mode == REFLEX else "",
        )  # fmt: skip

    def start_joint_position_control(self, _mode: object) -> RobotInMemory:
        self.starts += 1
        return self

    def readOnce(self) -> Any:  # noqa: N802
        return self.read_once(), SimpleNamespace(to_sec=lambda: 0.001)

    def writeOnce(self, command: Any) -> None:  # noqa: N802
        if command.motion_finished and self.has_reflex_at_end:
            self.mode = REFLEX

    def automatic_error_recovery(self) -> None:
        self.recoveries += 1
        self.mode = IDLE

    def __getattr__(self, name: str) -> Any:
        def accept(*_: object) -> None:
            """Accept a setting."""

        return accept


@pytest.fixture
def robot() -> RobotInMemory:
    """Return a robot at rest."""
    return RobotInMemory()


@pytest.fixture
def controller(robot: RobotInMemory) -> FrankaJointController:
    """Return its controller, which may move."""

    def joint_positions(q: list[float]) -> Any:
        return SimpleNamespace(q=q, motion_finished=False)

    def connected(*_: object) -> RobotInMemory:
        return robot

    library = SimpleNamespace(
        RealtimeConfig=SimpleNamespace(kEnforce=0, kIgnore=1),
        ControllerMode=SimpleNamespace(JointImpedance=0),
        NetworkException=ConnectionError,
        JointPositions=joint_positions,
        Robot=connected,
        __version__="0",
    )
    made = FrankaJointController(FrankaOptions(host="memory"), load_library=lambda: library)
    made.connect()
    enable(made)
    return made


def enable(controller: FrankaJointController) -> None:
    """Set tool and load, and begin to hold."""
    controller.enable(tcp_xyz_m=np.zeros(3), load_kg=0.0, load_com_m=np.zeros(3))


def test_a_reflex_while_the_tool_is_set_again_is_recovered_by_a_person_only(
    controller: FrankaJointController, robot: RobotInMemory
) -> None:
    robot.has_reflex_at_end = True
    with pytest.raises(MotionRefused, match="reflex: joint_reflex"):
        enable(controller)
    assert (robot.recoveries, robot.starts) == (0, 1)
    assert controller.read().stopped_by == "reflex: joint_reflex"
    enable(controller)
    assert (robot.recoveries, robot.starts) == (1, 2)
