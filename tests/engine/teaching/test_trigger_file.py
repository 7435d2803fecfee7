"""Triggers are kept as YAML: what was written by hand stays, what is wrong is refused and changes nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from engine.errors import DocumentError
from engine.skills.teaching import Trigger
from engine.teaching.teach_document import parse_triggers
from engine.teaching.trigger_file import TriggerFile, rewrite_triggers

WRITTEN = """\
# Of the media controller at station 1.
flexcell: 1
triggers:
  # The left button.
  - trig_name: joints        # now
    robot_ns: left
    trig_topic: /keypress/previous
    trig_type: rising_edge
    trig_callback: joint_save
  - {trig_name: float, robot_ns: left, trig_topic: keypress/play, trig_type: hold, trig_callback: grav_comp}
"""


def kept(folder: Path, text: str) -> TriggerFile:
    (folder / "triggers.yaml").write_text(text, encoding="utf-8")
    file = TriggerFile(folder / "triggers.yaml")
    file.load()
    return file


def test_a_trigger_that_is_as_it_was_keeps_its_lines_and_comments(tmp_path: Path) -> None:
    file = kept(tmp_path, WRITTEN)
    joints, floating = file.load()
    other = Trigger(
        trig_name="pose: now", robot_ns="", trig_topic="a/b", trig_type="hold", trig_callback="pose_save", trig_value=1
    )
    assert file.write((joints, other)) == (joints, other)
    text = (tmp_path / "triggers.yaml").read_text(encoding="utf-8")
    assert text.startswith(WRITTEN[: WRITTEN.index("  - {")])
    assert floating.trig_name not in text
    assert '- trig_name: "pose: now"' in text


def test_a_document_that_is_wrong_changes_nothing(tmp_path: Path) -> None:
    file = kept(tmp_path, WRITTEN)
    with pytest.raises(DocumentError) as refused:
        file.write_text(WRITTEN.replace("rising_edge", "rising"))
    assert ":8:" in str(refused.value.where)
    assert (tmp_path / "triggers.yaml").read_text(encoding="utf-8") == WRITTEN
    assert file.text == WRITTEN


def test_what_is_kept_is_there_for_the_next_one(tmp_path: Path) -> None:
    triggers = kept(tmp_path, WRITTEN).load()
    TriggerFile(tmp_path / "new" / "triggers.yaml").write(triggers)
    assert TriggerFile(tmp_path / "new" / "triggers.yaml").load() == triggers
    assert TriggerFile(None, triggers).load() == triggers


words = st.text(st.characters(codec="utf-8", exclude_categories=("Cc", "Cs", "Cn", "Co", "Zl", "Zp")), max_size=20)
some_triggers = st.lists(
    st.builds(
        Trigger,
        trig_name=words.filter(bool),
        robot_ns=words,
        trig_topic=words.filter(bool),
        trig_type=st.sampled_from(("rising_edge", "falling_edge", "hold")),
        trig_callback=st.sampled_from(("joint_save", "tf_save", "grav_comp")),
        trig_value=st.booleans() | st.integers(-(2**53), 2**53) | words,
        field=words,
        source_frame=words,
    ),
    max_size=4,
    unique_by=lambda one: one.trig_name,
).map(tuple)


@example(
    before=(),
    after=(
        Trigger(
            trig_name="\ufeff",
            robot_ns="",
            trig_topic="a\u200b",
            trig_type="hold",
            trig_callback="tf_save",
            source_frame="\ufeffbase",
        ),
    ),
)
@given(before=some_triggers, after=some_triggers)
def test_any_triggers_are_read_back_as_they_were_written(
    before: tuple[Trigger, ...], after: tuple[Trigger, ...]
) -> None:
    """Also over what was there before, and one that comes again keeps its place among them."""
    text = rewrite_triggers(
        rewrite_triggers("", before), (*after, *(one for one in before if one.trig_name not in names(after)))
    )
    read = parse_triggers(text, file="t")
    assert read[: len(after)] == after


def names(triggers: tuple[Trigger, ...]) -> set[str]:
    return {one.trig_name for one in triggers}
