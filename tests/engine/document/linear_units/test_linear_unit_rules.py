"""Linear units in documents: what leads nowhere, cannot move, or is beyond the travel is refused at its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import Cell, load_cell
from engine.errors import DocumentError, Position

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  arm: {model: ur10, base: {frame: carriage, xyz: [0, 0, 0.05]}}
fixtures:
  carriage: {shape: box, size_m: [0.3, 0.3, 0.1], at: {xyz: [0, 0, 0.1]}}
  box: {shape: box, size_m: [0.1, 0.1, 0.1], at: {frame: carriage, xyz: [0.2, 0, 0]}}
  post: {shape: box, size_m: [0.1, 0.1, 0.1], at: {xyz: [0.7, 0, 0]}}
frames:
  grip: {parent: post}
  aboard: {parent: carriage}
devices:
  rail:
    linear_unit:
      robot: arm
      carriage: carriage
      carries: [box]
      along: [0, 2, 0]
      travel_m: [-0.1, 0.8]
      brakes: release
      anchors: {post: grip}
      places: {home: 0, far: 0.8}
    positions:
      released: {steps: [{set: {release: true}}], time: 0.3 s}
      locked: {steps: [{set: {release: false}}], time: 0.3 s}
"""


def unit_cell(folder: Path, *changes: tuple[str, str], more: str = "") -> Cell:
    """Return the cell with a linear unit whose text is changed."""
    text = CELL
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    (folder / "cell.yaml").write_text(text + more, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


def test_a_robot_stands_on_the_carriage_with_what_that_carries(tmp_path: Path) -> None:
    device = unit_cell(tmp_path).document.devices["rail"]
    unit = device.linear_unit
    assert unit is not None
    assert (device.moved_fixtures, device.braked) == (("carriage", "box"), unit)
    assert unit.direction(unit_cell(tmp_path).document.fixtures["carriage"].at.pose()) == pytest.approx((0.0, 1.0, 0.0))


def test_a_place_says_by_how_much_it_is_beyond_the_travel(tmp_path: Path) -> None:
    unit = unit_cell(tmp_path).document.devices["rail"].linear_unit
    assert unit is not None
    assert unit.beyond_travel(-0.1) == ""
    assert unit.beyond_travel(-0.125) == "the carriage would be 25.0 mm beyond its travel of -100.0 … 800.0 mm"
    assert unit.beyond_travel(0.9) == "the carriage would be 100.0 mm beyond its travel of -100.0 … 800.0 mm"


@pytest.mark.parametrize(
    ("old", "new", "message", "line"),
    [
        ("far: 0.8", "far: 0.85", "at the place `far`, the carriage would be 50.0 mm beyond its travel", 23),
        ("[-0.1, 0.8]", "[0.1, 0.8]", "the place of the document, 0, is not within the travel", 20),
        ("along: [0, 2, 0]", "along: [0, 1, 0.1]", "the rail is tilted by 5.7°", 19),
        ("along: [0, 2, 0]", "along: [0, 0, 0]", "this direction has no length", 19),
        ("robot: arm", "robot: amr", "there is no robot `amr`", 16),
        ("base: {frame: carriage", "base: {frame: post", "`arm` does not stand on `carriage`", 16),
        ("model: ur10,", "model: ur10, driver: {kind: x},", "`arm` has a driver, and its base cannot move", 16),
        ("carriage: carriage\n", "carriage: carriag\n", "there is no fixture `carriag`", 17),
        ("carries: [box]", "carries: []", "`box` stands on `carriage` and would not move with it", 16),
        ("carries: [box]", "carries: [box, post]", "`post` does not stand on `carriage`", 18),
        ("post: grip", "post: gripp", "there is no frame `gripp`", 22),
        ("post: grip", "post: aboard", "`aboard` stands on the carriage itself", 22),
        ("brakes: release", "brakes: relase", "no step sets the output `relase`", 21),
        ("      locked:", "      braked:", "the device has no position `locked` for its brakes", 15),
        (
            "  aboard: {parent: carriage}",
            "  aboard: {}\ncameras: {eye: {at: [1, 1, 1], look_at: [0, 0, 0]}}",
            "the cell has cameras",
            17,
        ),
    ],
)
def test_what_cannot_be_is_refused_at_its_place(tmp_path: Path, old: str, new: str, message: str, line: int) -> None:
    with pytest.raises(DocumentError) as raised:
        unit_cell(tmp_path, (old, new))
    where = raised.value.where
    assert message in raised.value.message
    assert isinstance(where, Position)
    assert where.line == line


def test_another_robot_does_not_stand_on_the_carriage(tmp_path: Path) -> None:
    other = ("  arm: {model", "  other: {model: ur10, base: {frame: box}}\n  arm: {model")
    with pytest.raises(DocumentError, match="`other` stands on the carriage of `rail`, which moves"):
        unit_cell(tmp_path, other)


def test_a_module_has_no_linear_unit(tmp_path: Path) -> None:
    """It knows no robot."""
    (tmp_path / "rail").mkdir()
    start = CELL.index("fixtures:")
    module = "flexcell: 1\nmodule: rail\n" + CELL[start:].replace("at: {xyz", "at: {xyz")
    (tmp_path / "rail" / "module.yaml").write_text(module, encoding="utf-8")
    cell = "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nconnectors: {dock: {}}\n"
    (tmp_path / "cell.yaml").write_text(cell + "modules: {unit: {module: rail, connector: dock}}\n", encoding="utf-8")
    with pytest.raises(DocumentError, match="a module has no robot"):
        load_cell(tmp_path / "cell.yaml")
