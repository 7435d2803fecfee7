"""Module documents: what they may say, and where it is said what is wrong."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from engine.document.module_document import load_module
from engine.errors import DocumentError

MODULE = """\
flexcell: 1
module: bin
description: A tray with a block in its slot.
frames:
  slot: {parent: tray}
fixtures:
  tray: {shape: tray, size_m: [0.3, 0.2, 0.03]}
parts:
  block: {shape: box, size_m: [0.04, 0.04, 0.04], mass_kg: 0.1, at: {frame: slot}}
cameras:
  eye: {at: [0, 0, 0.8], look_at: [0, 0, 0]}
"""


def test_a_module_is_read_from_its_folder(tmp_path: Path) -> None:
    (tmp_path / "module.yaml").write_text(MODULE, encoding="utf-8")
    module = load_module(tmp_path)
    assert module.document.module == "bin"
    assert module.file == tmp_path / "module.yaml"
    assert load_module(module.file).document == module.document


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "{frame: slot}",
            "{frame: slit}",
            "module.yaml:9:77: `block` stands in `slit`, which is no frame",
        ),
        (
            "{frame: slot}",
            "{frame: world}",
            "module.yaml:9:77: `block` stands in `world`, which a module does",
        ),
        ("{parent: tray}", "{parent: world}", "module.yaml:5:18: `slot` stands in `world`, which a module does not"),
        ("at: [0, 0, 0.8]", "frame: world, at: [0, 0, 0.8]", "module.yaml:11:16: `eye` stands in `world`"),
        ("0.03]", "0.03], at: {frame: world}", "module.yaml:7:61: `tray` stands in `world`"),
        ("[0.04, 0.04, 0.04]", "[0.04, 0.04]", "module.yaml:9:31: the size of a box has 3 lengths, not 2"),
        ("  block:", "  tray:", "module.yaml:9:3: `tray` is both a fixture and a part"),
        ("  slot:", "  eye:", "module.yaml:5:3: `eye` is both a frame and a camera"),
        ("module: bin", "module: bin\nrobots: {}", "module.yaml:3:1: unknown key `robots`"),
    ],
)
def test_what_a_module_may_not_say_is_refused_where_it_is_written(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in MODULE
    (tmp_path / "module.yaml").write_text(MODULE.replace(old, new), encoding="utf-8")
    with pytest.raises(DocumentError, match=re.escape(message)):
        load_module(tmp_path)
