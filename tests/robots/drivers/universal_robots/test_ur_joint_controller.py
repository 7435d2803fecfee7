"""A tool that is set again at rest, without a person: a script that has ended meanwhile is not started again."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from robots.drivers.arm.joint_controller import MotionRefused
from robots.drivers.universal_robots.ur_joint_controller import UrJointController
from robots.drivers.universal_robots.ur_options import UrOptions


class LibraryInMemory(ModuleType):
    """`rtde_control` and `rtde_receive` with a controller that executes what it gets."""

    def __init__(self) -> None:
        super().__init__("library")
        self.is_running = False
        self.uploads = 0
        self.RTDEControlInterface = self.RTDEReceiveInterface = self.connected

    def connected(self, *_: object) -> LibraryInMemory:
        return self

    def reuploadScript(self) -> None:  # noqa: N802
        self.uploads += 1
        self.is_running = True

    def isProgramRunning(self) -> bool:  # noqa: N802
        return self.is_running

    def getRobotStatus(self) -> int:  # noqa: N802
        return 3 if self.is_running else 1

    def getSafetyStatusBits(self) -> int:  # noqa: N802
        return 1

    def getRobotMode(self) -> int:  # noqa: N802
        return 7

    def getRuntimeState(self) -> int:  # noqa: N802
        return 2 if self.is_running else 1

    def __getattr__(self, name: str) -> Any:
        def accept(*_: object) -> bool:
            return True

        return accept


def enable(controller: UrJointController) -> None:
    """Set tool and load."""
    controller.enable(tcp_xyz_m=np.zeros(3), load_kg=0.0, load_com_m=np.zeros(3))


def test_a_script_that_has_ended_since_the_last_reading_is_not_uploaded_without_a_person(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    library = LibraryInMemory()
    for name in ("rtde_control", "rtde_receive"):
        monkeypatch.setitem(sys.modules, name, library)
    controller = UrJointController(UrOptions(host="127.0.0.254"))
    controller.connect()
    library.is_running = True
    enable(controller)
    library.is_running = False
    with pytest.raises(MotionRefused, match="program ended"):
        enable(controller)
    assert library.uploads == 0
    with pytest.raises(MotionRefused, match="program ended"):
        controller.command(np.zeros(6), np.zeros(6))
    enable(controller)
    assert library.uploads == 1
