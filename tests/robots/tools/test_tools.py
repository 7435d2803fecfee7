"""The tools' data agree with their descriptions: openings, tool centres, joints on the tendon, faces."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from robots.magnet.magnet_model import MagnetModel
from robots.model import ClawModel, GripperModel, LinkageModel, Mechanism, PadBox, SynergyModel
from robots.model.mechanics.pinocchio_model import pin, rest_configuration, whole_model
from robots.model.registry import robot_model
from robots.model.robot_model import RobotModel
from robots.port import Array


def in_flange(model: RobotModel, link: str, joints: Mapping[str, float]) -> Array:
    """Return the transform, shape (4, 4), of a link in the flange with the tool's joints at some angles."""
    full = whole_model(model)
    data, q = full.createData(), rest_configuration(full, model)
    for name, value in joints.items():
        q[full.joints[full.getJointId(name)].idx_q] = value
    pin.framesForwardKinematics(full, data, q)
    flange = data.oMf[full.getFrameId(model.flange_link)]
    return np.array((flange.inverse() * data.oMf[full.getFrameId(link)]).homogeneous)


def with_tool(name: str) -> tuple[RobotModel, Mechanism]:
    """Return the UR10 with a tool, and the tool's mechanism."""
    model = robot_model("ur10", gripper=name)
    assert model.tool is not None
    assert model.tool.name == name
    return model, model.tool.mechanism


def pads_of(model: RobotModel, pads: tuple[PadBox, PadBox], joints: Mapping[str, float]) -> tuple[Array, float]:
    """Return the middle between the pads in the flange, and the opening between their faces."""
    left, right = (in_flange(model, pad.link, joints) @ (*pad.xyz, 1.0) for pad in pads)
    return (left + right)[:3] / 2, float(np.linalg.norm((left - right)[:3])) - pads[0].size_m[1]


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_the_pads_of_the_panda_hand_are_as_far_apart_as_its_fingers_say(share: float) -> None:
    model, hand = with_tool("panda_hand")
    assert isinstance(hand, GripperModel)
    width = share * hand.max_width_m
    _, opening = pads_of(model, hand.pads, dict.fromkeys(hand.finger_joints, width / 2))
    assert opening == pytest.approx(width, abs=1e-9)


def test_the_2f85_opens_as_wide_as_its_data_sheet_says_and_closes() -> None:
    model, gripper = with_tool("robotiq_2f85")
    assert isinstance(gripper, LinkageModel)

    def opening(angle: float) -> float:
        joints = {gripper.driver: angle} | {name: factor * angle for name, factor in gripper.followers.items()}
        return pads_of(model, gripper.pads, joints)[1]

    assert opening(gripper.open_rad) == pytest.approx(gripper.max_width_m, abs=0.0015)
    assert 0.0 <= opening(gripper.closed_rad) < 0.002
    assert set(gripper.followers) | {gripper.driver} == set(model.tool.joints if model.tool is not None else ())


def test_the_tool_centre_of_the_2f85_lies_between_its_pads_171_mm_out_of_the_flange() -> None:
    model, gripper = with_tool("robotiq_2f85")
    assert isinstance(gripper, LinkageModel)
    centre = in_flange(model, model.tool_link, {})[:3, 3]
    assert np.allclose(centre, (0.0, 0.0, 0.171), atol=1e-9)
    joints = {gripper.driver: 0.8} | {name: factor * 0.8 for name, factor in gripper.followers.items()}
    middle, _ = pads_of(model, gripper.pads, joints)
    assert abs(centre[2] - middle[2]) < gripper.pads[0].size_m[2] / 2
    assert np.allclose(middle[:2], 0.0, atol=1e-6)


def test_the_2f85_weighs_what_its_data_sheet_says_wherever_it_is_mounted() -> None:
    for arm in ("panda", "ur10"):
        tool = robot_model(arm, gripper="robotiq_2f85").tool
        assert tool is not None
        assert tool.mass_kg == pytest.approx(0.9)


def test_the_claw_opens_for_the_tube_and_closes_to_less_than_its_diameter() -> None:
    model, claw = with_tool("servo_claw")
    assert isinstance(claw, ClawModel)
    tube_m = 0.01

    def opening(angle: float) -> float:
        return pads_of(model, claw.pads, {claw.driver: angle, **{n: f * angle for n, f in claw.followers.items()}})[1]

    assert opening(claw.closed_rad) < tube_m < 3 * tube_m < opening(claw.open_rad)
    assert opening(claw.open_rad) == pytest.approx(claw.max_width_m, abs=0.001)
    turned = claw.servo_open_rad - claw.servo_closed_rad
    assert np.degrees((claw.servo_closed_rad, claw.servo_open_rad)) == pytest.approx((45.0, 90.0))
    assert abs(claw.open_rad - claw.closed_rad) == pytest.approx(turned)


def test_the_tool_centre_of_the_magnet_is_the_middle_of_its_face() -> None:
    model, magnet = with_tool("magnet")
    assert isinstance(magnet, MagnetModel)
    face = in_flange(model, magnet.face.link, {}) @ (*magnet.face.xyz, 1.0)
    surface_m = face[2] + magnet.face.size_m[2] / 2
    assert in_flange(model, model.tool_link, {})[2, 3] == pytest.approx(surface_m)
    assert magnet.max_force_n > 3 * 9.81 * magnet.max_payload_kg * 0.99


def test_the_tendon_of_the_soft_hand_is_as_long_as_all_its_joints_take() -> None:
    model, hand = with_tool("softhand")
    assert isinstance(hand, SynergyModel)
    full = whole_model(model)
    taken_m = sum(
        j.radius_m * full.upperPositionLimit[full.joints[full.getJointId(j.name)].idx_q] for j in hand.flexion
    )
    assert hand.travel_m == pytest.approx(taken_m, abs=1e-6)
    assert len(hand.flexion) + len(hand.passive) == 19
    assert len(hand.fingers) == 5


def test_closing_the_soft_hand_brings_the_fingertips_in_front_of_the_palm() -> None:
    """All four fingers and the thumb: y is out of the palm."""
    model, hand = with_tool("softhand")
    assert isinstance(hand, SynergyModel)
    closed = {joint.name: 0.9 for joint in hand.flexion}
    palm = np.linalg.inv(in_flange(model, hand.palm_link, {}))
    for finger in hand.fingers:
        open_tip, closed_tip = ((palm @ in_flange(model, finger[-1], q))[:3, 3] for q in ({}, closed))
        assert closed_tip[1] > 0.03, finger[-1]
        if not finger[0].startswith("softhand_thumb"):
            assert closed_tip[1] > open_tip[1] + 0.03
            assert closed_tip[2] < open_tip[2]
        else:
            assert closed_tip[0] > open_tip[0] + 0.01
