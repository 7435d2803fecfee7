"""Factory calibration of the UR10 against the chain of the six transforms that its file gives."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import CellError, DocumentError
from robots.model.folder.calibration import load_calibration, roll_pitch_yaw, transform
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import ARMS_DIR, robot_model
from robots.model.transform import RigidTransform
from robots.port import Array

ORIGIN = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
PRINTED = ARMS_DIR / "ur10" / "ur10_calibration.yaml"
SEGMENTS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
KEYS = ("x", "y", "z", "roll", "pitch", "yaw")
# As printed in the appendix.
NUMBERS = {
    "shoulder": (0.0, 0.0, 0.1273, 0.0, 0.0, 0.0),
    "upper_arm": (0.0, 0.0, 0.0, 1.570796327, 0.0, 0.0),
    "forearm": (-0.612, 0.0, 0.0, 0.0, 0.0, 0.0),
    "wrist_1": (-0.5723, 0.0, 0.163941, 0.0, 0.0, 0.0),
    "wrist_2": (0.0, -0.1157, -2.373046667922381e-11, 1.570796327, 0.0, 0.0),
    "wrist_3": (0.0, 0.0922, -1.891053610911353e-11, 1.570796326589793, 3.141592653589793, 3.141592653589793),
}
POSES = np.random.default_rng(1).uniform(-3.0, 3.0, (50, 6))


def chain(numbers: dict[str, tuple[float, ...]], joints: Array) -> Array:
    """Multiply up a calibration by hand: base turned by half a turn, then segment and joint in turn."""

    def turned(angle: float) -> Array:
        c, s = math.cos(angle), math.sin(angle)
        return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])

    def placed(x: float, y: float, z: float, roll: float, pitch: float, yaw: float) -> Array:
        about_x = np.array([[1, 0, 0], [0, math.cos(roll), -math.sin(roll)], [0, math.sin(roll), math.cos(roll)]])
        about_y = np.array([[math.cos(pitch), 0, math.sin(pitch)], [0, 1, 0], [-math.sin(pitch), 0, math.cos(pitch)]])
        result = np.eye(4)
        result[:3, :3] = turned(yaw)[:3, :3] @ about_y @ about_x
        result[:3, 3] = (x, y, z)
        return result

    pose = turned(math.pi)
    for name, angle in zip(SEGMENTS, joints, strict=True):
        pose = pose @ placed(*numbers[name]) @ turned(angle)
    return pose


def written(file: Path, numbers: dict[str, tuple[float, ...]]) -> Path:
    """Write a calibration file."""
    lines = ["kinematics:"]
    for name, values in numbers.items():
        lines += [f"  {name}:", *(f"    {key}: {value!r}" for key, value in zip(KEYS, values, strict=True))]
    file.write_text("\n".join([*lines, "hash: calib_1", ""]))
    return file


def kinematics(calibration: Path | None) -> ArmKinematics:
    """Return the bare UR10."""
    return ArmKinematics(robot_model("ur10", gripper=None, calibration=calibration), base=ORIGIN)


def test_the_printed_file_is_read_as_printed() -> None:
    calibration = load_calibration(PRINTED)
    assert calibration.hash == "calib_17227329492635474227"
    read = {name: tuple(getattr(segment, key) for key in KEYS) for name, segment in calibration.segments.items()}
    assert read == NUMBERS


def test_the_nominal_arm_is_the_printed_calibration_to_a_nanometre() -> None:
    """So the file of the appendix is that of an arm without deviations."""
    nominal = kinematics(None)
    for joints in POSES:
        pose, expected = nominal.tool_pose(joints), chain(NUMBERS, joints)
        assert np.abs(pose.xyz - expected[:3, 3]).max() < 1e-9
        assert np.abs(pose.rotation - expected[:3, :3]).max() < 1e-8


def test_with_the_printed_file_the_arm_has_its_hash_and_stands_where_the_file_says() -> None:
    calibrated = kinematics(PRINTED)
    assert calibrated.model.calibration == "calib_17227329492635474227"
    for joints in POSES:
        assert np.abs(calibrated.tool_pose(joints).xyz - chain(NUMBERS, joints)[:3, 3]).max() < 1e-9


deviations = st.lists(st.floats(-0.005, 0.005), min_size=36, max_size=36)


@settings(max_examples=20, deadline=None)
@given(deviations, st.integers(0, 49))
def test_any_deviation_moves_the_tool_to_where_the_chain_of_the_file_puts_it(
    tmp_path_factory: pytest.TempPathFactory, values: list[float], pose_number: int
) -> None:
    """Each segment off by up to 5 mm and 5 mrad in every direction."""
    numbers = {
        name: tuple(v + d for v, d in zip(NUMBERS[name], values[6 * i : 6 * i + 6], strict=True))
        for i, name in enumerate(SEGMENTS)
    }
    file = written(tmp_path_factory.mktemp("calibration") / "mine.yaml", numbers)
    joints = POSES[pose_number]
    pose, expected = kinematics(file).tool_pose(joints), chain(numbers, joints)
    # The URDF writes a quarter turn with eleven digits.
    assert np.abs(pose.xyz - expected[:3, 3]).max() < 1e-8
    assert np.abs(pose.rotation - expected[:3, :3]).max() < 1e-8


def test_a_real_deviation_is_millimetres_at_the_tool(tmp_path: Path) -> None:
    """A forearm 1.5 mm too long and a shoulder 2 mrad off."""
    numbers = NUMBERS | {
        "forearm": (-0.6135, 0.0, 0.0, 0.0, 0.0, 0.0),
        "upper_arm": (0.0, 0.0, 0.0, 1.572796327, 0.0, 0.0),
    }
    nominal, calibrated = kinematics(None), kinematics(written(tmp_path / "c.yaml", numbers))
    off = [nominal.tool_pose(q).distance_m(calibrated.tool_pose(q)) for q in POSES]
    assert 0.001 < max(off) < 0.006


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("wrist_3:", "wrist_4:", "segment wrist_3 is missing"),
        (
            "  shoulder:",
            "  shoulders: {x: 0, y: 0, z: 0, roll: 0, pitch: 0, yaw: 0}\n  shoulder:",
            "no segment shoulders .did you mean shoulder",
        ),
        ("z: 0.1273", "z: high", r"c\.yaml:5:\d+: `z`"),
    ],
)
def test_a_file_that_does_not_fit_the_robot_is_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    file = written(tmp_path / "c.yaml", NUMBERS)
    file.write_text(file.read_text().replace(old, new))
    with pytest.raises(DocumentError, match=words):
        kinematics(file)


def test_a_calibration_of_another_urdf_is_refused(tmp_path: Path) -> None:
    """The nominal file must describe the URDF, or every calibration would be wrong."""
    for file in (ARMS_DIR / "ur10").iterdir():
        (tmp_path / file.name).write_text(file.read_text())
    written(tmp_path / "ur10_calibration.yaml", NUMBERS | {"forearm": (-0.425, 0.0, 0.0, 0.0, 0.0, 0.0)})
    with pytest.raises(CellError, match=r"elbow_joint differs by 187\.000 mm"):
        robot_model(str(tmp_path), gripper=None, calibration=PRINTED)


angles = st.floats(-3.1, 3.1)


@given(angles, st.one_of(st.floats(-1.5707, 1.5707), st.sampled_from([-math.pi / 2, math.pi / 2])), angles)
def test_angles_of_a_transform_give_the_transform_back(roll: float, pitch: float, yaw: float) -> None:
    """Also where pitch is a quarter turn and roll and yaw are one."""
    placed = transform((0.0, 0.0, 0.0), (roll, pitch, yaw))
    assert np.abs(transform((0.0, 0.0, 0.0), roll_pitch_yaw(placed)) - placed).max() < 1e-12
