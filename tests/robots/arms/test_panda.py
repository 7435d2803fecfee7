"""The Panda's data agree with its description and its installed files."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import pytest

from engine.errors import CellError
from robots.model.registry import model_by_name
from robots.model.urdf.description import installed_share_dir, resolve_uri

PANDA = model_by_name("panda")
DESCRIBED = PANDA.licence_file.parent / "urdf" / "panda.urdf"


def test_every_name_it_uses_is_in_the_urdf() -> None:
    root = ET.fromstring(PANDA.urdf_text)
    names = {element.attrib["name"] for element in (*root.iter("link"), *root.iter("joint"))}
    gripper = PANDA.gripper
    assert gripper is not None
    used = {PANDA.base_link, PANDA.tool_link, *PANDA.arm_joints, *gripper.finger_joints, *gripper.finger_links}
    assert used <= names
    assert {link for pair in PANDA.allowed_collisions for link in pair} <= names


def test_its_position_velocity_and_effort_limits_are_those_of_the_urdf() -> None:
    joints = {joint.attrib["name"]: joint for joint in ET.parse(DESCRIBED).getroot().iter("joint")}
    for index, name in enumerate(PANDA.arm_joints):
        limit = joints[name].find("limit")
        assert limit is not None
        described = tuple(float(limit.attrib[key]) for key in ("lower", "upper", "velocity", "effort"))
        limits = PANDA.limits
        own = (
            limits.lower_rad[index],
            limits.upper_rad[index],
            limits.velocity_rad_s[index],
            limits.effort_nm[index],
        )
        assert own == described


def test_its_home_is_within_its_limits() -> None:
    limits = PANDA.limits
    assert all(
        lower < at < upper for lower, at, upper in zip(limits.lower_rad, PANDA.home_rad, limits.upper_rad, strict=True)
    )


def test_its_licence_comes_with_it() -> None:
    assert PANDA.licence == "Apache-2.0"
    assert "Apache License" in PANDA.licence_file.read_text(encoding="utf-8")


def test_an_unknown_model_is_refused_with_the_near_name() -> None:
    with pytest.raises(CellError, match="did you mean panda"):
        model_by_name("pnda")


def test_a_missing_package_is_named_with_the_way_to_install_it() -> None:
    with pytest.raises(CellError, match=r"no-such-robots is not installed \(pip install no-such-robots\)"):
        installed_share_dir(package="no-such-robots", marker="x")


def test_a_missing_mesh_is_named() -> None:
    with pytest.raises(CellError, match="no mesh file"):
        resolve_uri("package://nowhere/link.dae", package_dirs=PANDA.package_dirs, relative_to=DESCRIBED.parent)
