"""Named frames of a cell: where they are, and what a document of them may not say."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from engine.document.cell import CellDocument, load_cell
from engine.errors import DocumentError

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
        ("  slot: {parent: tabel}", "9:18", "is no fixture and no frame", "did you mean table?"),
        ("  slot: {parent: plate}", "9:18", "`plate`, is no fixture and no frame", "known: table, world"),
        ("  slot: {parent: slot}", "9:18", "is itself", "known: table, world"),
        ("  a: {parent: b}\n  b: {parent: a}", "9:15", "a → b → a are parents of one another", "to `world`"),
        ("  a: {parent: b}\n  b: {parent: c}\n  c: {parent: b}", "10:15", "b → c → b are parents", "to `world`"),
        ("  plate: {}", "9:3", "`plate` is both a frame and a part", "rename one"),
        ("  left: {}", "9:3", "`left` is both a frame and a robot", "rename one"),
        ("  world: {}", "9:3", "`world` is both a frame and a root frame", "rename one"),
        ("  slot: {at: {xyz: [0, 0]}}", "9:", "xyz", ""),
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


def test_a_long_chain_of_frames_is_placed(tmp_path: Path) -> None:
    """Each a step further and turned."""
    count = 200
    lines = [f"  f{n}: {{parent: {f'f{n - 1}' if n else 'world'}, at: {{xyz: [0.01, 0, 0]}}}}" for n in range(count)]
    poses = document(tmp_path, "\n".join(reversed(lines))).fixed_frames
    assert math.isclose(poses[f"f{count - 1}"].xyz[0], 0.01 * count)
