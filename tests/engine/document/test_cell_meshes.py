"""A fixture that is a mesh says its file and no size; other shapes have none of what a mesh has."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import load_cell
from engine.errors import DocumentError


@pytest.mark.parametrize(
    ("fixture", "message", "hint"),
    [
        ("{shape: mesh}", "a mesh needs its file", "add `file: NAME.stl`"),
        ("{shape: mesh, file: a.step}", "`a.step` is no mesh file", "ends in .stl, .obj, .dae"),
        ("{shape: mesh, file: a.stl, size_m: [1, 1, 1]}", "a mesh has no `size_m`", "the size is that of the file"),
        ("{shape: mesh, file: a.stl, spring: {stiffness_n_m: 10}}", "a mesh has no `spring`", "sprung box"),
        ("{shape: box, size_m: [1, 1, 1], file: a.stl}", "a box has no `file`", "write `shape: mesh`"),
        ("{shape: box, size_m: [1, 1, 1], scale: 0.1}", "a box has no `scale`", "write `shape: mesh`"),
        ("{shape: mesh, file: a.stl, scale: 0}", "expected number > 0.0", ""),
        ("{shape: box}", "the size of a box has 3 lengths, not 0", "edge lengths"),
    ],
)
def test_what_does_not_fit_is_refused_at_its_line(tmp_path: Path, fixture: str, message: str, hint: str) -> None:
    file = tmp_path / "cell.yaml"
    text = f"flexcell: 1\ncell: bench\nworld: {{kind: mujoco}}\nfixtures:\n  it: {fixture}\n"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(DocumentError) as error:
        load_cell(file)
    assert message in error.value.message
    assert hint in (error.value.hint or "")
    assert str(error.value.where).startswith(f"{file}:5:")


DEVICE = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
fixtures:
  jaw: {shape: mesh, file: a.stl}
devices:
  vice:
    axes:
      main: {body: jaw, joint: slide, along: [1, 0, 0], stroke_m: 0.05, force_n: 6, speed_m_s: 1, output: close}
    positions:
      closed: {steps: [{set: {close: true}}], time: 1}
"""


def test_a_mesh_is_not_moved_by_an_axis(tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(DEVICE, encoding="utf-8")
    with pytest.raises(DocumentError, match="`jaw` cannot be moved by an axis"):
        load_cell(file)
