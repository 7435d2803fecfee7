"""Trigger documents are read in the document's own shape, and refused with the position."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.errors import DocumentError
from engine.teaching import load_triggers

ENTRY = """
- trig_name: Record joint state
  robot_ns: /left
  trig_topic: /keypress/previous
  trig_type: rising_edge
  trig_value: true
  trig_callback: joint_save
"""


def written(folder: Path, text: str) -> Path:
    file = folder / "triggers.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_a_bare_list_is_read(tmp_path: Path) -> None:
    (trigger,) = load_triggers(written(tmp_path, ENTRY))
    assert (trigger.trig_name, trigger.trig_type, trigger.trig_callback, trigger.trig_value) == (
        "Record joint state",
        "rising_edge",
        "joint_save",
        True,
    )


def test_a_document_is_read(tmp_path: Path) -> None:
    text = "flexcell: 1\ntriggers:\n" + "".join(f"  {line}\n" for line in ENTRY.strip().splitlines())
    assert load_triggers(written(tmp_path, text)) == load_triggers(written(tmp_path, ENTRY))


def test_a_name_is_used_once(tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match="two triggers have the name 'Record joint state'") as refused:
        load_triggers(written(tmp_path, ENTRY + ENTRY.lstrip()))
    assert refused.value.where is not None
    assert str(refused.value.where).endswith("triggers.yaml:8:14")


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [("rising_edge", "rising", 5), ("joint_save", "save", 7), ("trig_topic", "topic", 4)],
)
def test_what_is_wrong_is_named_with_its_line(tmp_path: Path, old: str, new: str, line: int) -> None:
    with pytest.raises(DocumentError) as refused:
        load_triggers(written(tmp_path, ENTRY.replace(old, new)))
    assert f":{line}:" in str(refused.value.where)
