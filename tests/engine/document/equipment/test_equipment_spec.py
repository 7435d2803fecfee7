"""Equipment in cell documents: its driver, the document of its pins, and names that are taken."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document import load_cell
from engine.errors import DocumentError

PINS = """\
flexcell: 1
equipment: clamps
backend: {kind: simulated}
pins:
  clamp: {kind: digital_output, pin: 17, safe: true}
  there: {kind: digital_input, pin: 27}
  blower: {kind: pwm, pin: 12, safe: 0.0}
"""


def written(folder: Path, equipment: str, *, more: str = "") -> Path:
    """Write a cell with this equipment."""
    (folder / "clamps.yaml").write_text(PINS, encoding="utf-8")
    (folder / "broken.yaml").write_text(PINS.replace("safe: true", "save: true"), encoding="utf-8")
    (folder / "cell.yaml").write_text(f"flexcell: 1\ncell: bench\n{more}equipment:\n  {equipment}\n", encoding="utf-8")
    return folder / "cell.yaml"


def test_pins_are_read_with_the_cell(tmp_path: Path) -> None:
    cell = load_cell(written(tmp_path, "vice: {driver: {kind: equipment, host: 10.0.0.2}, pins: clamps.yaml}"))
    pins = cell.pins["vice"].document
    assert (pins.outputs, pins.inputs) == ({"clamp": 0}, {"there": 0})
    assert cell.document.real_devices == {"vice": "equipment"}


def test_a_change_of_the_pins_is_one_of_the_cell(tmp_path: Path) -> None:
    file = written(tmp_path, "vice: {pins: clamps.yaml}")
    before = load_cell(file).content
    (tmp_path / "clamps.yaml").write_text(PINS.replace("17", "18"), encoding="utf-8")
    assert load_cell(file).content != before


@pytest.mark.parametrize(
    ("equipment", "more", "message", "where"),
    [
        ("vice: {}", "", "equipment `vice` is simulated, but nothing names its pins", "cell.yaml:4:3"),
        ("vice: {pins: gone.yaml}", "", "there is no file gone.yaml", "cell.yaml:4:16"),
        ("vice: {pins: broken.yaml}", "", "save", "broken.yaml:5:"),
        ("vice: {driver: {host: a}}", "", "the driver of equipment `vice` has no `kind`", "cell.yaml:4:18"),
        ("eye: {pins: clamps.yaml}", "cameras: {eye: {at: [1, 0, 1], look_at: [0, 0, 0]}}\n",
         "`eye` is both equipment and a camera", "cell.yaml:5:3"),
        ("store: {pins: clamps.yaml}", "", "`store` is both equipment and a name of flexcell itself", "cell.yaml:4:3"),
        ("vice: {pins: clamps.yaml}", "topics: {vice/ready: {type: boolean}}\n",
         "those of equipment `vice`", "cell.yaml:3:"),
    ],
)  # fmt: skip
def test_a_mistake_has_its_place(tmp_path: Path, equipment: str, more: str, message: str, where: str) -> None:
    with pytest.raises(DocumentError, match=message) as refused:
        load_cell(written(tmp_path, equipment, more=more))
    assert where in str(refused.value.where)
