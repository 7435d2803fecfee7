"""Where a part lies is judged from the measured poses."""

from __future__ import annotations

import math

import msgspec
import pytest

from engine.errors import Cause, MeasuredValue, StateError
from engine.messages import FramePoses, PartPoses, Pose, Quaternion, Vector3
from engine.messages.pose_algebra import compose_rotations
from engine.state import Outcome
from states.cell.expect_part import ExpectPart, Region
from states.cell.part_orientation import ExpectedOrientation
from tests.states.fake_context import FakeContext

TRAY = Region(center_m=(0.0, 0.28), size_m=(0.36, 0.22))


UPRIGHT: Quaternion = (0.0, 0.0, 0.0, 1.0)
MIDDLE: Vector3 = (0.0, 0.28, 0.02)


def turned(*, x_deg: float = 0.0, z_deg: float = 0.0) -> Quaternion:
    """Turn about the x axis of the world, then about its z axis."""
    x, z = (math.radians(angle) / 2 for angle in (x_deg, z_deg))
    return compose_rotations((0.0, 0.0, math.sin(z), math.cos(z)), (math.sin(x), 0.0, 0.0, math.cos(x)))


def cell(
    xyz: Vector3,
    xyzw: Quaternion = UPRIGHT,
    *,
    up: dict[str, Vector3 | None] | None = None,
    frame: Quaternion = UPRIGHT,
) -> FakeContext:
    """Put the part at a place, beside one frame."""
    parts = PartPoses(time_s=0.0, poses={"hca_north": Pose(xyz=xyz, xyzw=xyzw)}, up=up or {})
    frames = FramePoses(time_s=0.0, names=("tray_south",), xyz=((0.0, -0.28, 0.0),), xyzw=(frame,))
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
        compared=(MeasuredValue(quantity="x of its centre", measured=300.0, unit="mm", least=-180.0, most=180.0),),
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
    assert "(0.060, -0.280, 0.000) m, 60.0 mm from tray_south, 50.0 mm allowed" in str(outcome.cause)
    assert outcome.cause is not None
    (compared,) = outcome.cause.chain()[1].compared
    assert (compared.quantity, compared.unit, compared.most) == ("distance from tray_south", "mm", 50.0)
    assert compared.measured == pytest.approx(60.0)


async def test_an_unknown_frame_is_an_error() -> None:
    """A typo in the behavior is no place a part could be at."""
    with pytest.raises(StateError, match=r"the cell shows no frame tray_suth \(did you mean tray_south\?\)"):
        await ExpectPart(part="hca_north", frame="tray_suth").run(cell((0, 0, 0)))


@pytest.mark.parametrize("given", [{}, {"frame": "a", "region": {"center_m": [0, 0], "size_m": [1, 1]}}])
def test_region_and_frame_exclude_one_another(given: dict[str, object]) -> None:
    """One of them must be given, and only one."""
    with pytest.raises(msgspec.ValidationError, match="either `region` or `frame`"):
        msgspec.convert({"part": "hca_north", **given}, ExpectPart)


@pytest.mark.parametrize(("x_deg", "tilt"), [(90.0, "90.0 deg"), (12.0, "12.0 deg"), (180.0, "180.0 deg")])
async def test_a_part_that_toppled_is_not_there_though_its_centre_is(x_deg: float, tilt: str) -> None:
    """Without a word about orientation: what pointed up must point up."""
    outcome = await ExpectPart(part="hca_north", region=TRAY).run(cell(MIDDLE, turned(x_deg=x_deg, z_deg=40.0)))
    assert outcome.name == "elsewhere"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "part hca_north lies at its region, turned otherwise than expected",
        f"it is tilted by {tilt}, 9.7 deg allowed",
    ]
    (compared,) = outcome.cause.chain()[1].compared
    assert (compared.quantity, compared.unit) == ("tilt", "deg")
    assert (compared.measured, compared.most) == pytest.approx((x_deg, math.degrees(0.17)))


@pytest.mark.parametrize("xyzw", [turned(z_deg=140.0), turned(x_deg=9.0, z_deg=-70.0)])
async def test_a_part_that_turned_about_the_vertical_or_leans_a_little_is_there(xyzw: Quaternion) -> None:
    """The tolerance of 0.17 rad is that of the tilt alone."""
    assert await ExpectPart(part="hca_north", region=TRAY).run(cell(MIDDLE, xyzw)) == Outcome("there")


async def test_the_tolerance_of_the_tilt_is_a_parameter() -> None:
    """A smaller one refuses what leans; the largest accepts what lies anyhow."""
    leaning = cell(MIDDLE, turned(x_deg=9.0))
    assert (await ExpectPart(part="hca_north", region=TRAY, tilt_rad=0.1).run(leaning)).name == "elsewhere"
    upside_down = cell(MIDDLE, turned(x_deg=180.0))
    assert (await ExpectPart(part="hca_north", region=TRAY, tilt_rad=3.15).run(upside_down)).name == "there"


@pytest.mark.parametrize(
    ("up", "x_deg", "outcome"),
    [((0.0, -1.0, 0.0), 90.0, "elsewhere"), ((0.0, 1.0, 0.0), 90.0, "there"), ((0.0, 1.0, 0.0), 0.0, "elsewhere")],
)
async def test_the_cell_tells_which_axis_of_a_part_points_up(up: Vector3, x_deg: float, outcome: str) -> None:
    """A part that the cell document places on its side stands on that side."""
    ctx = cell(MIDDLE, turned(x_deg=x_deg), up={"hca_north": up})
    assert (await ExpectPart(part="hca_north", region=TRAY).run(ctx)).name == outcome


async def test_a_ball_has_no_up() -> None:
    """However it has rolled."""
    ctx = cell(MIDDLE, turned(x_deg=77.0), up={"hca_north": None})
    assert await ExpectPart(part="hca_north", region=TRAY).run(ctx) == Outcome("there")


ALONG_X = ExpectedOrientation(xyzw=turned(z_deg=30.0))


@pytest.mark.parametrize(
    ("expected", "xyzw", "off_deg"),
    [
        (ALONG_X, turned(z_deg=33.0), None),
        (ALONG_X, turned(z_deg=50.0), 20.0),
        (ALONG_X, turned(z_deg=210.0), 180.0),
        (ExpectedOrientation(xyzw=turned(z_deg=30.0), symmetry_axis=(0, 0, 2), turns=2), turned(z_deg=212.0), None),
        (ExpectedOrientation(xyzw=turned(z_deg=30.0), symmetry_axis=(0, 0, 2), turns=2), turned(z_deg=120.0), 90.0),
        (ExpectedOrientation(xyzw=turned(z_deg=30.0), symmetry_axis=(0, 0, 1), turns=4), turned(z_deg=120.0), None),
        (ExpectedOrientation(symmetry_axis=(0, 0, 1)), turned(x_deg=5.0, z_deg=77.0), None),
        (ExpectedOrientation(symmetry_axis=(0, 0, 1)), turned(x_deg=25.0, z_deg=77.0), 25.0),
        # A lying cylinder may roll, and may not turn on the table.
        (ExpectedOrientation(xyzw=turned(x_deg=90.0), symmetry_axis=(0, 0, 1)), turned(x_deg=90.0, z_deg=15.0), 15.0),
        (
            ExpectedOrientation(xyzw=turned(x_deg=90.0), symmetry_axis=(0, 0, 1)),
            compose_rotations(turned(x_deg=90.0), turned(z_deg=123.0)),
            None,
        ),
    ],
)
async def test_an_expected_orientation_is_compared_with_the_symmetry_of_the_part(
    expected: ExpectedOrientation, xyzw: Quaternion, off_deg: float | None
) -> None:
    """The cause has both angles in degrees."""
    outcome = await ExpectPart(part="hca_north", region=TRAY, orientation=expected).run(cell(MIDDLE, xyzw))
    if off_deg is None:
        assert outcome == Outcome("there")
        return
    assert outcome.name == "elsewhere"
    assert outcome.cause is not None
    because = outcome.cause.chain()[1]
    assert because.message == f"it is turned by {off_deg:.1f} deg from its orientation, 9.7 deg allowed"
    assert because.compared[0].measured == pytest.approx(off_deg)


async def test_an_orientation_is_relative_to_the_frame() -> None:
    """A tray that stands turned has its part turned with it."""
    state = ExpectPart(part="hca_north", frame="tray_south", orientation=ExpectedOrientation())
    place = (0.0, -0.28, 0.0)
    assert (await state.run(cell(place, turned(z_deg=60.0), frame=turned(z_deg=60.0)))).name == "there"
    assert (await state.run(cell(place, frame=turned(z_deg=60.0)))).name == "elsewhere"


async def test_a_part_that_fell_off_toppled_tells_both() -> None:
    """One cause, with the numbers of both."""
    outcome = await ExpectPart(part="hca_north", region=TRAY).run(cell((0.3, 0.28, 0.02), turned(x_deg=90.0)))
    assert outcome.cause is not None
    assert outcome.cause.message == "part hca_north does not lie at its region"
    assert [value.quantity for value in outcome.cause.chain()[1].compared] == ["x of its centre", "tilt"]
    assert outcome.cause.chain()[1].message.endswith("around (0.000, 0.280); it is tilted by 90.0 deg, 9.7 deg allowed")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"xyzw": [0, 0, 0, 0.5]}, "unit quaternion"),
        ({"symmetry_axis": [0, 0, 0]}, "zero vector"),
        ({"turns": 2}, "give it too"),
    ],
)
def test_an_orientation_that_means_nothing_is_refused(given: dict[str, object], message: str) -> None:
    with pytest.raises(msgspec.ValidationError, match=message):
        msgspec.convert(given, ExpectedOrientation)
