"""Where the links of an arm are: the same places as the robots' own kinematics says."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from editor_web.cell_view.rendering.transforms import (
    WorldPose,
    inverse,
    matrix_of_pose,
    pose_of_matrix,
    poses_by_frame,
    rotation,
)
from editor_web.cell_view.rendering.urdf_tree import UrdfTree
from engine.errors import FlexcellError
from engine.messages import Pose
from robots.port import Array
from tests.editor_web.fake_scene import frames_at
from tests.editor_web.fake_sights import ARMS, JOINTS, URDF, description, joints_at
from tests.robots.panda_arm import BASE, configurations, panda_kinematics, panda_model


@settings(max_examples=25, deadline=None)
@given(st.sampled_from(sorted(ARMS)), st.floats(0.0, 60.0))
def test_the_links_stand_where_the_frames_of_the_cell_say(arm: str, time_s: float) -> None:
    joints = dict(zip(JOINTS, joints_at(arm, time_s), strict=True))
    links = UrdfTree(URDF).links(matrix_of_pose(description(arm).base), joints, seen={})
    frames = poses_by_frame(frames_at(time_s))
    for name in ("base", "upper", "fore"):
        assert np.allclose(links[name], matrix_of_pose(frames[f"{arm}/{name}"]), atol=1e-9)


@settings(max_examples=25, deadline=None)
@given(configurations())
def test_the_hand_of_a_panda_stands_where_the_robots_kinematics_puts_it(joints: Array) -> None:
    """From the text of its URDF alone."""
    model = panda_model()
    base = BASE.to_pose("world")
    values = dict(zip(model.arm_joints, joints.tolist(), strict=True))
    found = pose_of_matrix(UrdfTree(model.urdf_text).links(matrix_of_pose(base), values, seen={})[model.tool_link])
    expected = panda_kinematics().tool_pose(joints).to_pose("world")
    assert np.allclose(found.xyz, expected.xyz, atol=1e-9)
    assert abs(float(np.dot(found.xyzw, expected.xyzw))) > 1 - 1e-9


def test_what_no_joint_of_the_way_moves_stays_with_its_parent_as_it_was_seen() -> None:
    """As open fingers do, or a tool that was changed."""
    seen = {"fore": matrix_of_pose(Pose(xyz=(1.0, 2.0, 3.0))), "tool": matrix_of_pose(Pose(xyz=(1.0, 2.5, 3.0)))}
    links = UrdfTree(URDF.replace('type="fixed"', 'type="prismatic"')).links(
        np.eye(4), dict.fromkeys(JOINTS, 0.0), seen=seen
    )
    assert np.allclose(links["tool"][:3, 3], links["fore"][:3, 3] + [0.0, 0.5, 0.0])


def test_only_what_a_joint_of_the_way_carries_moves() -> None:
    linkage = UrdfTree(URDF)
    assert linkage.root == "foot"
    assert linkage.moved_by(("lean",)) == {"upper", "fore", "tool"}
    assert linkage.moved_by(JOINTS) == {"base", "upper", "fore", "tool"}


@pytest.mark.parametrize(
    "urdf",
    [
        "no XML",
        "<robot/>",
        URDF.replace('<link name="foot"/>', ""),
        URDF.replace('<child link="base"/>', '<child link="upper"/>'),
        URDF.replace('xyz="0 0 0.4"', 'xyz="0 0"', 1),
    ],
)
def test_what_is_no_tree_of_links_is_refused(urdf: str) -> None:
    with pytest.raises(FlexcellError):
        UrdfTree(urdf)


units = st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1)


@given(units, st.tuples(*[st.floats(-9, 9)] * 3))
def test_a_pose_becomes_a_transform_and_back(quaternion: list[float], xyz: tuple[float, float, float]) -> None:
    x, y, z, w = (float(v) for v in np.array(quaternion) / np.linalg.norm(quaternion))
    transform = matrix_of_pose(WorldPose(xyz=xyz, xyzw=(x, y, z, w)))
    back = pose_of_matrix(transform)
    assert np.allclose(back.xyz, xyz)
    assert np.allclose(rotation(back.xyzw), rotation((x, y, z, w)), atol=1e-9)
    assert np.allclose(inverse(transform) @ transform, np.eye(4), atol=1e-9)
