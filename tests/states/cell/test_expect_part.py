"""Where a part lies is judged from the measured poses."""

from __future__ import annotations

import msgspec
import pytest

from engine.errors import Cause, StateError
from engine.messages import FramePoses, PartPoses, Pose, Vector3
from engine.state import Outcome
from states.cell.expect_part import ExpectPart, Region
from tests.states.fake_context import FakeContext

TRAY = Region(center_m=(0.0, 0.28), size_m=(0.36, 0.22))


def cell(xyz: Vector3) -> FakeContext:
    """Put the part at a place, beside one frame."""
    parts = PartPoses(time_s=0.0, poses={"hca_north": Pose(xyz=xyz)})
    frames = FramePoses(time_s=0.0, names=("tray_south",), xyz=((0.0, -0.28, 0.0),), xyzw=((0.0, 0.0, 0.0, 1.0),))
    return FakeContext(topics={"cell/parts": parts, "cell/frames": frames})


@pytest.mark.parametrize("xyz", [(0.0, 0.28, 0.02), (0.17, 0.38, 0.5), (-0.17, 0.18, 0.0)])
async def test_a_part_inside_the_region_is_there(xyz: Vector3) -> None:
    """Anywhere in the rectangle, at any height when none is given."""
    assert await ExpectPart(part="hca_north", region=TRAY).run(cell(xyz)) == Outcome("there")


async def test_a_part_outside_is_elsewhere_with_its_measured_place() -> None:
    """The cause says where it lies and where it should."""
    outcome = await ExpectPart(part="hca_north", region=TRAY).run(cell((0.3, 0.28, 0.02)))
    because = Cause(
        message="it lies at (0.300, 0.280, 0.020) m, not within 0.360 x 0.220 m around (0.000, 0.280)",
        where="cell/parts",
    )
    assert outcome == Outcome(
        "elsewhere",
        cause=Cause(
            message="part hca_north does not lie at its region",
            where="root/step",
            kind="cell.ExpectPart",
            because=because,
        ),
    )


async def test_a_part_held_above_its_tray_is_not_there_when_heights_matter() -> None:
    """A height range tells lying from being carried."""
    region = Region(center_m=(0.0, 0.28), size_m=(0.36, 0.22), height_m=(0.0, 0.05))
    outcome = await ExpectPart(part="hca_north", region=region).run(cell((0.0, 0.28, 0.3)))
    assert outcome.name == "elsewhere"
    assert "heights 0.000 to 0.050 m" in str(outcome.cause)


async def test_a_missing_part_is_named_with_those_there_are() -> None:
    """A part that was never put in is elsewhere, and the cause names it."""
    outcome = await ExpectPart(part="hca_nort", region=TRAY).run(cell((0, 0, 0)))
    assert outcome.name == "elsewhere"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "part hca_nort does not lie at its region",
        "no such part is in the cell; did you mean hca_north?",
    ]


async def test_a_part_near_a_frame_is_there_and_a_far_one_is_not() -> None:
    """The message reports the distance in space."""
    state = ExpectPart(part="hca_north", frame="tray_south", tolerance_m=0.05)
    assert await state.run(cell((0.03, -0.28, 0.03))) == Outcome("there")
    outcome = await state.run(cell((0.06, -0.28, 0.0)))
    assert outcome.name == "elsewhere"
    assert "(0.060, -0.280, 0.000) m, 0.060 m from tray_south, 0.050 m allowed" in str(outcome.cause)
    assert outcome.cause is not None
    (compared,) = outcome.cause.chain()[1].compared
    assert (compared.quantity, compared.unit, compared.most) == ("distance from tray_south", "m", 0.05)
    assert compared.measured == pytest.approx(0.06)


async def test_an_unknown_frame_is_an_error() -> None:
    """A typo in the behavior is no place a part could be at."""
    with pytest.raises(StateError, match=r"the cell shows no frame tray_suth \(did you mean tray_south\?\)"):
        await ExpectPart(part="hca_north", frame="tray_suth").run(cell((0, 0, 0)))


@pytest.mark.parametrize("given", [{}, {"frame": "a", "region": {"center_m": [0, 0], "size_m": [1, 1]}}])
def test_region_and_frame_exclude_one_another(given: dict[str, object]) -> None:
    """One of them must be given, and only one."""
    with pytest.raises(msgspec.ValidationError, match="either `region` or `frame`"):
        msgspec.convert({"part": "hca_north", **given}, ExpectPart)
