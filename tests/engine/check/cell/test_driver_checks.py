"""Drivers of a cell are checked: their names, their devices, their options, and what behaviors ask of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from engine.cell.cell_names import CellNames
from engine.cell.drivers import Driver, DriverOptions
from engine.check import check_behavior, check_cell
from engine.document import load_behavior, load_cell
from engine.registry import load_states
from engine.skills.contact import MoveUntilContact
from engine.skills.gripper import GripperGrasp
from engine.skills.motion import JointTrapVel

OPTIONS = "kind: robotiq, connection: {kind: modbus_tcp, host: 192.168.1.11}"
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left:
    model: ur10
    gripper:
      model: robotiq_2f85
      driver: {DRIVER}
"""


def finding_texts(folder: Path, cell: str) -> list[str]:
    """Check a cell; returns its findings as they are printed, without the folder."""
    (folder / "cell.yaml").write_text(cell, encoding="utf-8")
    return [str(found).replace(f"{folder.resolve()}/", "") for found in check_cell(load_cell(folder / "cell.yaml"))]


def test_a_tool_with_a_driver_on_a_simulated_arm_has_no_findings(tmp_path: Path) -> None:
    assert finding_texts(tmp_path, CELL.replace("DRIVER", OPTIONS)) == []


@pytest.mark.parametrize(
    ("driver", "finding"),
    [
        (
            "kind: robotik",
            "9:22: error: there is no driver `robotik` (did you mean robotiq?) [unknown-driver]",
        ),
        (
            "kind: robotiq, connection: {kind: modbus_tcp, hots: 192.168.1.11}",
            "9:62: error: driver robotiq: unknown key `hots` (did you mean host?) [bad-driver-option]",
        ),
        (
            f"{OPTIONS}, unit: 300",
            "9:89: error: driver robotiq: `unit`: expected integer <= 247 (Modbus address of the gripper)"
            " [bad-driver-option]",
        ),
        (
            "kind: robotiq",
            "9:7: error: driver robotiq: the key `connection` is missing [bad-driver-option]",
        ),
        (
            "kind: robotiq, connection: {kind: bluetooth}",
            "9:50: error: driver robotiq: `kind`: invalid value 'bluetooth' [bad-driver-option]",
        ),
    ],
)
def test_what_is_wrong_with_a_driver_is_found_where_it_stands(tmp_path: Path, driver: str, finding: str) -> None:
    assert finding_texts(tmp_path, CELL.replace("DRIVER", driver)) == [f"cell.yaml:{finding}"]


def test_all_wrong_options_are_found_at_once(tmp_path: Path) -> None:
    driver = "kind: robotiq, unit: 300, period_s: 9, connection: {kind: serial, device: /dev/ttyUSB0}"
    found = finding_texts(tmp_path, CELL.replace("DRIVER", driver))
    assert len(found) == 2
    assert all("[bad-driver-option]" in text for text in found)


def test_a_driver_fits_its_model_and_its_kind_of_device(tmp_path: Path) -> None:
    other = CELL.replace("DRIVER", OPTIONS).replace("robotiq_2f85", "panda_hand").replace("ur10", "panda")
    assert finding_texts(tmp_path, other) == [
        "cell.yaml:9:22: error: the driver robotiq drives robotiq_2f85, not panda_hand"
        " (see docs/how-to/connect-a-robotiq-gripper.md) [unfit-driver]"
    ]
    arm = f"flexcell: 1\ncell: bench\nrobots:\n  left: {{model: ur10, driver: {{{OPTIONS}}}}}\n"
    assert "drives tools, and this is an arm" in finding_texts(tmp_path, arm)[0]


class VendorOptions(DriverOptions, frozen=True, kw_only=True, tag="vendor_arm"):
    """A driver without options."""


VENDOR = Driver(
    kind="vendor_arm",
    drives="arm",
    options=VendorOptions,
    capabilities=frozenset({"trajectory"}),
    ports={},
    proven="nothing",
    page="nowhere",
    device="nowhere:nothing",
)
BEHAVIOR = """\
flexcell: 1
name: guide_it
cell: cell.yaml
outcomes: [finished, failed]
root:
  machine:
    initial: move
    states:
      move:
        state: motion.MoveJoints
        with: {robot: left, target: [0, -1, 1, 0, 0, 0]}
        transitions: {reached: guide, failed: failed}
      guide:
        state: motion.SetImpedance
        with: {robot: left, joint_stiffness: [100, 100, 100, 100, 100, 100]}
        transitions: {set: finished, failed: failed}
"""


def test_a_state_beyond_the_driver_of_its_arm_is_refused_with_the_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It can follow trajectories, and that state has no finding."""

    def load(group: str, kind: str) -> Any:
        return VENDOR

    monkeypatch.setattr("engine.cell.drivers.driver_registry.load_factory", load)
    (tmp_path / "cell.yaml").write_text(
        "flexcell: 1\ncell: bench\nrobots:\n  left: {model: ur10, driver: {kind: vendor_arm}}\n", encoding="utf-8"
    )
    (tmp_path / "guide.yaml").write_text(BEHAVIOR, encoding="utf-8")
    findings = check_behavior(load_behavior(tmp_path / "guide.yaml"), load_states())
    found = [(finding.path, finding.message) for finding in findings if finding.code == "beyond-driver"]
    reason = "the driver vendor_arm has no impedance control, only sampled trajectories"
    assert found == [("root/guide", f"motion.SetImpedance cannot be executed by `left`: {reason}")]


def test_a_composed_state_needs_of_each_device_what_the_device_itself_does() -> None:
    """A driver of an arm needs no gripper commands for a state that also closes a gripper, and none of contacts."""
    names = CellNames(cell="bench", by_kind={}, drivers={"left": VENDOR})
    assert names.beyond_driver("robot", "left", (JointTrapVel, GripperGrasp)) == ""
    assert names.beyond_driver("gripper", "left", (JointTrapVel, GripperGrasp)) == ""
    reason = "the driver vendor_arm has no measured contact forces, only sampled trajectories"
    assert names.beyond_driver("robot", "left", (GripperGrasp, MoveUntilContact)) == reason
