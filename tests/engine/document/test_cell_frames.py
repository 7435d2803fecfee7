"""Named frames of a cell: where they are, and what a document of them may not say."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.cell import CellDocument, load_cell
from engine.document.placement import FramedPlacement, Placement
from engine.errors import DocumentError
from engine.messages import Vector3
from engine.messages.pose_algebra import angle_between_rad, compose_poses

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots: {left: {model: panda}}
fixtures:
  table: {shape: box, size_m: [1, 1, 0.1], at: {xyz: [0.5, 0, 0.2], rpy: [0, 0, 1.5707963267948966]}}
parts: {plate: {shape: box, size_m: [0.1, 0.1, 0.01], mass_kg: 0.1}}
frames:
"""


def document(folder: Path, frames: str) -> CellDocument:
    """Return the cell with these frames."""
    (folder / "cell.yaml").write_text(CELL + frames, encoding="utf-8")
    return load_cell(folder / "cell.yaml").document


def test_a_frame_stands_in_its_parent(tmp_path: Path) -> None:
    """In the world, on a fixture, in a frame that is written after it."""
    cell = document(
        tmp_path,
        "  slot: {parent: tray, at: {xyz: [0.1, 0, 0.01]}}\n"
        "  tray: {parent: table, at: {xyz: [0.2, 0, 0.05], rpy: [0, 0, 1.5707963267948966]}}\n"
        "  dock: {at: {xyz: [1, 2, 3]}}\n",
    )
    poses = cell.fixed_frames
    assert poses["dock"].xyz == (1.0, 2.0, 3.0)
    # The table is turned by 90°, so that the tray is beside it along y, and turned by 180° itself.
    assert poses["tray"].xyz == pytest.approx((0.5, 0.2, 0.25))
    assert poses["slot"].xyz == pytest.approx((0.4, 0.2, 0.26))
    assert poses["slot"].xyzw == pytest.approx((0.0, 0.0, 1.0, 0.0), abs=1e-9)
    assert all(pose.frame == "world" for pose in poses.values())
    assert list(poses) == ["slot", "tray", "dock"]


@pytest.mark.parametrize(
    ("frames", "place", "message", "hint"),
    [
        ("  slot: {parent: tabel}", "9:18", "`tabel`, which is no frame and no fixture", "did you mean table?"),
        ("  slot: {parent: plate}", "9:18", "`plate`, which is no frame and no fixture", "known: table, world"),
        ("  slot: {parent: slot}", "9:18", "`slot` stands in itself", "known: table, world"),
        ("  a: {parent: b}\n  b: {parent: a}", "9:15", "a → b → a stand in one another", "in `world`"),
        ("  a: {parent: b}\n  b: {parent: c}\n  c: {parent: b}", "10:15", "b → c → b stand in one", "in `world`"),
        ("  plate: {}", "9:3", "`plate` is both a frame and a part", "rename one"),
        ("  left: {}", "9:3", "`left` is both a frame and a robot", "rename one"),
        ("  world: {}", "9:3", "`world` is both a frame and a root frame", "rename one"),
        ("  slot: {at: {xyz: [0, 0]}}", "9:", "xyz", ""),
        (
            "  slot: {}\nunknown_bodies:\n  box: {shape: box, size_m: [1, 1, 1], at: {frame: slt}}",
            "11:",
            "`slt`",
            "slot?",
        ),
    ],
)
def test_what_is_no_frame_is_refused_at_its_place(
    tmp_path: Path, frames: str, place: str, message: str, hint: str
) -> None:
    """With what to write instead."""
    with pytest.raises(DocumentError) as refused:
        document(tmp_path, frames)
    assert f"cell.yaml:{place}" in str(refused.value)
    assert message in str(refused.value)
    assert hint in (refused.value.hint or "")


BODIES = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots: {left: {model: panda, base: {frame: pedestal, xyz: [0, 0, 0.4]}}}
fixtures:
  table: {shape: box, size_m: [1, 1, 0.1], at: {frame: corner, xyz: [0.5, 0.5, -0.05]}}
  pedestal: {shape: cylinder, size_m: [0.3, 0.8], at: {xyz: [1, 0, 0.4]}}
  tray: {shape: tray, size_m: [0.3, 0.2, 0.02], at: {frame: table, xyz: [0, 0.1, 0.05]}}
parts:
  plate: {shape: box, size_m: [0.1, 0.1, 0.01], mass_kg: 0.1, at: {frame: tray, xyz: [0.1, 0, 0.02]}}
frames:
  corner: {at: {xyz: [2, 0, 0.7], rpy: [0, 0, 1.5707963267948966]}}
"""


def test_bodies_and_robots_stand_in_frames_and_on_fixtures(tmp_path: Path) -> None:
    """A loaded cell has them in the world, so that nobody else has to know of frames."""
    (tmp_path / "cell.yaml").write_text(BODIES, encoding="utf-8")
    cell = load_cell(tmp_path / "cell.yaml").document
    assert cell.fixtures["table"].at.xyz == pytest.approx((1.5, 0.5, 0.65))
    assert cell.fixtures["tray"].at.xyz == pytest.approx((1.4, 0.5, 0.7))
    assert cell.parts["plate"].at.xyz == pytest.approx((1.4, 0.6, 0.72))
    assert cell.parts["plate"].at.rpy == pytest.approx((0.0, 0.0, math.pi / 2.0))
    assert cell.robots["left"].base.xyz == pytest.approx((1.0, 0.0, 0.8))
    assert {frame for _, frame in cell.uses_of_frames()} == {"world"}
    assert cell.in_world() == cell


def test_a_fixture_does_not_stand_on_what_stands_on_it(tmp_path: Path) -> None:
    """Frames and fixtures are one chain."""
    (tmp_path / "cell.yaml").write_text(BODIES.replace("at: {xyz: [2", "parent: tray, at: {xyz: [2"), encoding="utf-8")
    with pytest.raises(DocumentError, match=r"cell\.yaml:12:20: corner → tray → table → corner stand in one another"):
        load_cell(tmp_path / "cell.yaml")


CAMERA = "cameras: {{eye: {{at: [1, 0, 2], look_at: [1, 0, 0], detect: {{frame: corner{}}}}}}}\n"


def test_a_camera_detects_in_a_named_frame(tmp_path: Path) -> None:
    """Whose pose need not be written again."""
    (tmp_path / "cell.yaml").write_text(BODIES + CAMERA.format(""), encoding="utf-8")
    cell = load_cell(tmp_path / "cell.yaml").document
    detect = cell.cameras["eye"].detect
    assert detect is not None
    assert detect.frame_at.xyz == (2.0, 0.0, 0.7)
    assert detect.frame_at.rpy == pytest.approx((0.0, 0.0, math.pi / 2.0))
    assert cell.in_world() == cell
    (tmp_path / "cell.yaml").write_text(BODIES + CAMERA.format(", frame_at: {xyz: [1, 0, 0]}"), encoding="utf-8")
    with pytest.raises(DocumentError, match="detects in the frame `corner` of the cell, whose pose is known"):
        load_cell(tmp_path / "cell.yaml")


IN_CORNER = """\
occupancy: {center_m: [0, 0, 0], size_m: [8, 8, 8]}
cameras: {eye: {frame: corner, at: [1, 0, 1.3], look_at: [0, 0, 0]}}
people: {visitor: {frame: corner, shoulder: [0, 1, 0.5], hand_rests: [0, 0.6, 0.3]}}
"""


def test_cameras_and_people_stand_in_frames(tmp_path: Path) -> None:
    """The corner is turned by 90°: what is before it along x is along y of the world."""
    (tmp_path / "cell.yaml").write_text(BODIES + IN_CORNER, encoding="utf-8")
    cell = load_cell(tmp_path / "cell.yaml").document
    eye, visitor = cell.cameras["eye"], cell.people["visitor"]
    assert (*eye.at, *eye.look_at) == pytest.approx((2.0, 1.0, 2.0, 2.0, 0.0, 0.7))
    assert (*visitor.shoulder, *visitor.hand_rests) == pytest.approx((1.0, 0.0, 1.2, 1.4, 0.0, 1.0))
    assert cell.in_world() == cell
    (tmp_path / "cell.yaml").write_text(BODIES + IN_CORNER.replace("frame: corner, s", "frame: plate, s"), "utf-8")
    with pytest.raises(DocumentError, match=r"cell\.yaml:15:27: `visitor` stands in `plate`, which is no frame"):
        load_cell(tmp_path / "cell.yaml")


ANGLES = st.floats(-math.pi, math.pi) | st.sampled_from((0.0, math.pi / 2.0, -math.pi / 2.0, math.pi))


@given(rpy=st.tuples(ANGLES, ANGLES, ANGLES), turned=st.tuples(ANGLES, ANGLES, ANGLES))
def test_the_angles_of_what_stands_in_a_turned_frame_are_those_of_its_pose(rpy: Vector3, turned: Vector3) -> None:
    """Upright ones too, whose roll and yaw turn about one axis."""
    outer = Placement(xyz=(1.0, 2.0, 3.0), rpy=turned).pose()
    inner = FramedPlacement(frame="tray", xyz=(0.1, 0.2, 0.3), rpy=rpy)
    expected, found = compose_poses(outer, inner.pose()), inner.in_world({"tray": outer}).pose()
    assert found.xyz == pytest.approx(expected.xyz)
    assert angle_between_rad(found.xyzw, expected.xyzw) < 1e-4


def test_a_long_chain_of_frames_is_placed(tmp_path: Path) -> None:
    """Each a step further and turned."""
    count = 3000
    lines = [f"  f{n}: {{parent: {f'f{n - 1}' if n else 'world'}, at: {{xyz: [0.01, 0, 0]}}}}" for n in range(count)]
    poses = document(tmp_path, "\n".join(reversed(lines))).fixed_frames
    assert math.isclose(poses[f"f{count - 1}"].xyz[0], 0.01 * count)
