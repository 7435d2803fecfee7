"""How fast an arm may get in a motion whose path nobody knows: no configuration of a stream is faster than said."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings

from robots.control.generators.joint_streaming import JointStreamGenerator
from robots.control.generators.motion_generator import MotionGenerator
from robots.control.separation.motion_speed import MotionSpeed
from robots.port import Array
from robots.workspace.separation_measurement import link_extents_m
from tests.robots.panda_arm import configurations, panda_kinematics, panda_model

FOLDED = np.array([0.0, -1.5, 0.0, -3.0, 0.0, 1.6, 0.8])
STRETCHED = np.array([0.0, 1.2, 0.0, -0.2, 0.0, 1.0, 0.8])
LIMITS = panda_model().limits
EXTENTS_M = np.array(link_extents_m(panda_model()))


def _stream(start: Array) -> MotionGenerator:
    return JointStreamGenerator(limits=LIMITS, joints=panda_model().arm_joints, start=start, watchdog_s=0.1)


def _fastest_m_s(at: Array) -> float:
    """Return the speed of the fastest point with all joints at their limits, in the worst of all directions."""
    kinematics = panda_kinematics()
    rows = np.diag(np.array(LIMITS.velocity_rad_s))
    speeds = np.sum([kinematics.link_speeds(at, row) for row in rows], axis=0)
    ends = np.maximum(speeds[:, 0], np.append(speeds[1:, 0], speeds[-1, 0]))
    return float((ends + speeds[:, 1] * EXTENTS_M).max())


@settings(deadline=None, max_examples=60)
@given(configurations())
def test_no_configuration_of_a_stream_is_faster_than_said(at: Array) -> None:
    speed = MotionSpeed(_stream(FOLDED), kinematics=panda_kinematics().twin())
    assert speed.known
    assert _fastest_m_s(at) <= speed.fastest_m_s(tuple(EXTENTS_M.tolist())) + 1e-9


def test_a_stream_counts_with_the_arm_stretched_wherever_it_starts() -> None:
    said = [
        MotionSpeed(_stream(start), kinematics=panda_kinematics().twin()).fastest_m_s(tuple(EXTENTS_M.tolist()))
        for start in (FOLDED, STRETCHED)
    ]
    assert said[0] == said[1]
    assert said[0] == pytest.approx(_fastest_m_s(STRETCHED), rel=0.15)


def test_a_stream_counts_with_all_joints_at_their_limits() -> None:
    speed = MotionSpeed(_stream(FOLDED), kinematics=panda_kinematics().twin())
    assert speed.joints_rad_s.tolist() == list(LIMITS.velocity_rad_s)
    # 0.316 m at 4.35 rad/s, 0.0825 m at 6.525, 0.393 m at 8.7, 0.088 m at 13.92.
    assert speed.fastest_m_s((0.0,) * 7) == pytest.approx(6.555, abs=1e-3)


def test_links_are_as_long_as_in_the_data_sheet() -> None:
    elbow_m = float(np.hypot(0.384, 0.0825))
    assert panda_kinematics().link_lengths_m().tolist() == pytest.approx([0.0, 0.316, 0.0825, elbow_m, 0.0, 0.088])
