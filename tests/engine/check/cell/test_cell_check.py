"""A cell document is checked by itself: models, drivers, labels, outputs, entries and units."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.check import check_cell, check_entries_document
from engine.document.cell import load_cell
from engine.document.entries_document import load_entries

CELL = """\
flexcell: 1
cell: bench
store: {kind: sqlite, path: bench.db, seed: entries.yaml}
world: {kind: mujoco}
robots:
  left: {model: panda, gripper: {model: panda_hand}}
  right: {model: ur10, base: {xyz: [1, 0, 0], rpy: [0, 0, 3.14]}, outputs: {linear_axis: 9}}
parts:
  plate: {shape: box, size_m: [0.1, 0.1, 0.01], mass_kg: 0.1, at: {xyz: [0.4, 0, 0.1]}}
cameras:
  eye: {at: [1, 0, 1], look_at: [0, 0, 0], detect: {labels: {plate: steel plate}}}
"""
ENTRIES = """\
flexcell: 1
joints: {home: [0, -0.8, 0, -2.4, 0, 1.6, 0.8]}
poses:
  over: {xyz: [0.4, 0.1, 0.3], frame: plate}
  grasp: {xyz: [0, 0, 0], frame: part}
  beside: {xyz: [0.4, 0.1, 0.3], frame: left/panda_link0}
"""


def finding_texts(folder: Path, cell: str = CELL, entries: str | None = ENTRIES) -> list[str]:
    """Check a cell; returns its findings as they are printed, without the folder."""
    (folder / "cell.yaml").write_text(cell, encoding="utf-8")
    if entries is not None:
        (folder / "entries.yaml").write_text(entries, encoding="utf-8")
    return [str(found).replace(f"{folder.resolve()}/", "") for found in check_cell(load_cell(folder / "cell.yaml"))]


def test_a_good_cell_has_no_findings(tmp_path: Path) -> None:
    """With entries in the frames that it has, and in that of whatever part is gripped."""
    assert finding_texts(tmp_path) == []


@pytest.mark.parametrize(
    ("old", "new", "finding"),
    [
        (
            "model: panda,",
            "model: pandda,",
            "6:17: error: there is no robot model `pandda` (did you mean panda?) [unknown-model]",
        ),
        (
            "model: panda_hand",
            "model: panda_hnd",
            "6:41: error: there is no gripper model `panda_hnd` (did you mean panda_hand?) [unknown-model]",
        ),
        ("model: panda,", "model: ./mine,", "6:17: error: robot `left`: there is no robot.yaml in "),
        (
            "model: ur10,",
            "model: ur10, driver: {kind: ur_rtd},",
            "7:39: error: there is no driver `ur_rtd` (known: ",
        ),
        (
            "linear_axis: 9",
            "linear_axis: 10",
            "7:90: error: `right` has no output 10 (a ur10 has the outputs 0 to 9) [unknown-in-cell]",
        ),
        (
            "labels: {plate",
            "labels: {plat",
            "11:62: error: the cell bench has no part `plat` (did you mean plate?) [unknown-in-cell]",
        ),
        (
            "cameras:",
            "occupancy: {center_m: [0, 0, 0.5], size_m: [1, 1, 1]}\ncameras:",
            "10:1: warning: motions may pass through space that no camera has seen (name what the cameras must see in"
            " `must_cover`, or choose `unknown_space`) [unseen-space-accepted]",
        ),
        (
            "rpy: [0, 0, 3.14]",
            "rpy: [0, 0, 180]",
            "7:52: warning: `rpy`: 180 rad looks like degrees (if so, write [0, 0, 3.1416]) [suspect-unit]",
        ),
        (
            "[0.1, 0.1, 0.01]",
            "[100, 100, 10]",
            "9:31: warning: `size_m`: 100 m looks like millimetres (if so, write [0.1, 0.1, 0.01]) [suspect-unit]",
        ),
        (
            "seed: entries.yaml",
            "seed: none.yaml",
            "3:45: error: none.yaml: cannot read this file: No such file or directory (check its path) "
            "[invalid-document]",
        ),
    ],
)
def test_what_is_wrong_with_a_cell_is_reported_where_it_stands(
    tmp_path: Path, old: str, new: str, finding: str
) -> None:
    """With a near name, or what there is."""
    assert old in CELL
    (found,) = finding_texts(tmp_path, CELL.replace(old, new))
    assert found.removeprefix(f"{tmp_path}/").startswith(f"cell.yaml:{finding}")


def test_a_broken_model_folder_is_reported_at_its_own_document(tmp_path: Path) -> None:
    """Where the folder is there, and what it says is not valid."""
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "robot.yaml").write_text("flexcell: 1\nrobott: mine\n", encoding="utf-8")
    (found,) = finding_texts(tmp_path, CELL.replace("model: panda,", "model: ./mine,"))
    assert found.startswith("mine/robot.yaml:2:1: error: robot `left`: unknown key `robott`")


def test_the_entries_of_a_cell_are_checked_with_it(tmp_path: Path) -> None:
    """Frames that the cell has not, and numbers in another unit."""
    entries = ENTRIES.replace("frame: plate", "frame: plat").replace("-0.8, 0, -2.4", "-45, 0, -137")
    assert finding_texts(tmp_path, entries=entries) == [
        "entries.yaml:2:16: warning: `home`: -137 rad looks like degrees (if so, write "
        "[0, -0.7854, 0, -2.3911, 0, 0.0279, 0.014]) [suspect-unit]",
        "entries.yaml:4:39: error: the cell bench has no frame `plat` (did you mean plate?) [unknown-in-cell]",
    ]


def test_entries_alone_are_checked_without_frames(tmp_path: Path) -> None:
    """Nobody says in which cell they are."""
    file = tmp_path / "entries.yaml"
    file.write_text(ENTRIES.replace("frame: plate", "frame: any").replace("[0.4, 0.1, 0.3]", "[400, 100, 300]"))
    assert [(each.code, each.position.line) for each in check_entries_document(load_entries(file))] == [
        ("suspect-unit", 4),
        ("suspect-unit", 6),
    ]
