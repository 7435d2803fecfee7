"""The tool is set by a script that may not take it at once, and set again at rest, without a person."""

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
        self.refusals = 0
        self.ends_with_refusal = False
        self.RTDEControlInterface = self.RTDEReceiveInterface = self.connected

    def connected(self, *_: object) -> LibraryInMemory:
        return self

    def setTcp(self, _: object) -> bool:  # noqa: N802
        if not self.refusals:
            return True
        self.refusals -= 1
        self.is_running = not self.ends_with_refusal
        return False

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


@pytest.fixture
def library(monkeypatch: pytest.MonkeyPatch) -> LibraryInMemory:
    """What the driver imports, with a script that runs."""
    library = LibraryInMemory()
    for name in ("rtde_control", "rtde_receive"):
        monkeypatch.setitem(sys.modules, name, library)
    library.is_running = True
    return library


def connected() -> UrJointController:
    """Return a controller that is connected."""
    controller = UrJointController(UrOptions(host="127.0.0.254"))
    controller.connect()
    return controller


def test_a_tool_that_the_script_takes_late_is_set(library: LibraryInMemory) -> None:
    library.refusals = 2
    enable(connected())
    assert library.refusals == 0


def test_a_tool_that_is_never_taken_is_tried_five_times_and_named(library: LibraryInMemory) -> None:
    library.refusals = 1000
    with pytest.raises(MotionRefused, match=r"^program not ready: setTcp was refused 5 times; the controller says"):
        enable(connected())
    assert library.refusals == 995


def test_a_tool_that_a_script_refuses_as_it_ends_is_not_tried_again(library: LibraryInMemory) -> None:
    library.refusals, library.ends_with_refusal = 1000, True
    with pytest.raises(MotionRefused, match=r"^program ended: setTcp was refused; .* that a program does not run"):
        enable(connected())
    assert library.refusals == 999


def test_a_script_that_has_ended_since_the_last_reading_is_not_uploaded_without_a_person(
    library: LibraryInMemory,
) -> None:
    controller = connected()
    enable(controller)
    library.is_running = False
    with pytest.raises(MotionRefused, match="program ended"):
        enable(controller)
    assert library.uploads == 0
    with pytest.raises(MotionRefused, match="program ended"):
        controller.command(np.zeros(6), np.zeros(6))
    enable(controller)
    assert library.uploads == 1
