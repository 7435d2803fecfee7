"""The states that calibrate: what they write, and what they say about points that do not fit."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import pytest

from engine.errors import MeasuredValue
from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import rotate_vector
from engine.skills.entries import EntryRecord, ReadEntry
from engine.state import Outcome
from states.calibration.four_point_tool import FourPointTool
from states.calibration.three_point_frame import ThreePointFrame
from tests.states.fake_context import FakeContext

TIP: Vector3 = (0.01, -0.02, 0.13)
SINE, COSINE = math.sin(0.35), math.cos(0.35)
TURNS = ((0.0, 0.0, 0.0, 1.0), (SINE, 0.0, 0.0, COSINE), (0.0, SINE, 0.0, COSINE), (0.0, 0.0, SINE, COSINE))


def touches(*, lift_m: float = 0.0) -> tuple[Pose, ...]:
    """Poses whose tip is at the origin; in the last one it is lifted."""
    lifts = (0.0, 0.0, 0.0, lift_m)
    tips = [rotate_vector(turn, TIP) for turn in TURNS]
    return tuple(
        Pose(xyz=(-x, -y, lift - z), xyzw=turn)
        for (x, y, z), turn, lift in zip(tips, TURNS, lifts, strict=True)
    )  # fmt: skip


async def test_a_good_tool_centre_point_is_written_as_set_tool_frame_takes_it() -> None:
    outcome = await FourPointTool(robot="left", poses=touches()).run(FakeContext())
    assert outcome.name == "good"
    assert outcome.cause is None
    assert outcome.outputs["tool_xyz_m"] == pytest.approx(TIP)
    assert outcome.outputs["point_m"] == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    assert outcome.outputs["residual_m"] == pytest.approx(0.0, abs=1e-12)
    assert outcome.outputs["residuals_m"] == pytest.approx([0.0] * 4, abs=1e-12)


async def test_a_pose_that_misses_the_point_gives_a_poor_result_with_both_numbers() -> None:
    outcome = await FourPointTool(robot="left", poses=touches(lift_m=0.01), limit_m=0.001).run(FakeContext())
    assert outcome.name == "poor"
    assert outcome.cause is not None
    root = outcome.cause.chain()[-1]
    residual_m = max(msgspec.convert(outcome.outputs["residuals_m"], tuple[float, ...]))
    assert outcome.outputs["residual_m"] == residual_m
    assert 0.001 < residual_m < 0.01
    assert root.message.endswith(f"the tip is {residual_m * 1e3:.2f} mm from the common point, 1.00 mm allowed")
    assert root.compared == (MeasuredValue(quantity="residual", measured=residual_m * 1e3, unit="mm", most=1.0),)


async def test_alike_orientations_fail_and_write_nothing() -> None:
    same = Pose(xyz=(0.0, 0.0, 0.0))
    outcome = await FourPointTool(robot="left", poses=(same, same, same, same)).run(FakeContext())
    assert (outcome.name, outcome.outputs) == ("failed", {})
    assert outcome.cause is not None
    assert outcome.cause.message == "the tool centre point of left was not determined"
    assert outcome.cause.chain()[-1].message.startswith("the orientations are too alike")


def stored(*values: Vector3) -> FakeContext:
    """A store that has poses at these positions, to be read in this order."""
    records = [EntryRecord(kind="pose", name="touch", value={"xyz": list(xyz)}, revision=1) for xyz in values]
    return FakeContext({"store/read_entry": records})


async def test_poses_may_be_entries_of_the_store() -> None:
    ctx = stored((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    outcome = await FourPointTool(robot="left", entries=("a", "b", "c", "d")).run(ctx)
    assert outcome.name == "failed"
    assert ctx.sent == [("store/read_entry", ReadEntry(kind="pose", name=name)) for name in "abcd"]


async def test_a_frame_is_written_as_a_pose() -> None:
    outcome = await ThreePointFrame(points=points((0.1, 0.0, 0.5), (0.1, 0.3, 0.5), (-0.2, 0.1, 0.5))).run(
        FakeContext()
    )
    pose, half = outcome.outputs["pose"], math.sqrt(0.5)
    assert isinstance(pose, Pose)
    assert (outcome.name, pose.xyz, pose.frame) == ("good", (0.1, 0.0, 0.5), "world")
    assert pose.xyzw == pytest.approx((0.0, 0.0, half, half))
    assert outcome.outputs["residual_m"] == pytest.approx(0.0, abs=1e-12)


async def test_a_frame_of_entries_is_that_of_their_poses() -> None:
    ctx = stored((0.0, 0.0, 0.1), (0.3, 0.0, 0.1), (0.0, 0.3, 0.1))
    outcome = await ThreePointFrame(entries=("origin", "x", "plane")).run(ctx)
    assert outcome == Outcome("good", {"pose": Pose(xyz=(0.0, 0.0, 0.1)), "residual_m": 0.0})


async def test_points_beside_the_plane_give_a_poor_frame_with_both_numbers() -> None:
    given = points((0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.1, 0.2, 0.002), (0.1, 0.2, -0.002))
    outcome = await ThreePointFrame(points=given).run(FakeContext())
    assert outcome.name == "poor"
    assert outcome.outputs["residual_m"] == pytest.approx(0.002)
    assert outcome.cause is not None
    assert outcome.cause.chain()[-1].message == "a point is 2.00 mm from the xy plane, 0.50 mm allowed"


async def test_points_on_one_line_fail_with_the_distance() -> None:
    given = points((0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.6, 0.001, 0.0))
    outcome = await ThreePointFrame(points=given).run(FakeContext())
    assert (outcome.name, outcome.outputs) == ("failed", {})
    assert outcome.cause is not None
    assert "the point in the plane is 1.00 mm from the x axis" in outcome.cause.chain()[-1].message


def points(*positions: Vector3) -> tuple[Pose, ...]:
    """Poses at these positions."""
    return tuple(Pose(xyz=xyz) for xyz in positions)


@pytest.mark.parametrize("given", [{}, {"points": points((0.0, 0.0, 0.0)), "entries": ("a",)}])
def test_points_are_given_or_stored(given: dict[str, Any]) -> None:
    """Not neither or both."""
    with pytest.raises(ValueError, match="either `points` or `entries`"):
        ThreePointFrame(**given)
