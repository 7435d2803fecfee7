"""Random edits of a cell: the text says what the edits say, keeps its comments, and goes back byte by byte."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any, cast

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from engine.document.text.yaml_source import parse_source
from engine.editing.cells.cell_draft import read_cell_draft
from engine.editing.cells.cell_edit import (
    AddCellItem,
    AnyCellEdit,
    RemoveCellItem,
    RenameCellField,
    RenameCellItem,
    SetCellField,
)
from engine.editing.cells.cell_editing import apply_cell_edits
from tests.engine.editing.cells.cell_texts import CELL, write_cell

COMMENTS = ("# ours", "# left edge", "# what stands still", "# the table of 2019", "# measured", "# not the world")
# The fresh names are those of added items and of renamed ones.
NAMES = st.sampled_from(["fresh_a", "fresh_b", "fresh_c", "table", "slot"])
NUMBERS = st.one_of(st.integers(-3, 3), st.floats(-2, 2, allow_nan=False)).map(lambda each: round(each, 6))
VECTORS = st.lists(NUMBERS, min_size=3, max_size=3)
FRAMES = st.sampled_from(["world", "floor", "dock", "bin"])


def body(shape: dict[str, object], xyz: list[float], frame: str) -> dict[str, object]:
    """A fixture."""
    return {**shape, "at": {"xyz": xyz, "frame": frame}}


def frame_in(frame: str) -> dict[str, object]:
    """A frame in another."""
    return {"parent": frame}


SHAPES: list[dict[str, object]] = [
    {"shape": "box", "size_m": [0.1, 0.2, 0.3]},
    {"shape": "cylinder", "size_m": [0.1, 0.2]},
]
BODIES = st.builds(body, st.sampled_from(SHAPES), VECTORS, FRAMES)
EDITS: st.SearchStrategy[AnyCellEdit] = st.one_of(
    st.builds(AddCellItem, section=st.just("fixtures"), name=NAMES, value=BODIES),
    st.builds(AddCellItem, section=st.just("frames"), name=NAMES, value=st.builds(frame_in, FRAMES)),
    st.builds(RemoveCellItem, section=st.sampled_from(["fixtures", "frames"]), name=NAMES),
    st.builds(RenameCellItem, section=st.sampled_from(["fixtures", "frames"]), name=NAMES, new_name=NAMES),
    st.builds(
        SetCellField,
        section=st.just("fixtures"),
        name=NAMES,
        field=st.sampled_from([("at", "xyz"), ("at", "rpy")]),
        value=VECTORS | st.none(),
    ),
    st.builds(SetCellField, section=st.just("frames"), name=NAMES, field=st.just(("parent",)), value=FRAMES),
    st.builds(
        SetCellField, section=st.just("parts"), name=st.just("plate"), field=st.just(("at", "xyz")), value=VECTORS
    ),
)


def plain(data: dict[str, Any], edit: AnyCellEdit) -> None:
    """Make an edit on plain data; what it renames is renamed in every value that is the name."""
    items = data[edit.section]
    match edit:
        case AddCellItem():
            items[edit.name] = copy.deepcopy(edit.value)
        case RemoveCellItem():
            del items[edit.name]
        case RenameCellItem():
            renamed = _with_name(data, edit.name, edit.new_name)
            data.clear()
            data.update(renamed)
        case SetCellField(field=("at", key)):
            at = items[edit.name].setdefault("at", {})
            at.pop(key, None)
            if edit.value is not None:
                at[key] = edit.value
            if not at:
                del items[edit.name]["at"]
        case SetCellField():
            items[edit.name][edit.field[0]] = edit.value
        case RenameCellField():
            raise AssertionError("no device is under edit here")


def _with_name(value: Any, old: str, new: str) -> Any:
    if isinstance(value, dict):
        return {new if key == old else key: _with_name(each, old, new) for key, each in value.items()}  # pyright: ignore[reportUnknownVariableType]
    return new if value == old else value


@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(edits=st.lists(EDITS, max_size=12))
def test_random_edits_say_in_the_text_what_they_do_to_the_data(tmp_path_factory: Any, edits: list[AnyCellEdit]) -> None:
    file = _file(tmp_path_factory)
    texts = [CELL]
    expected: dict[str, Any] = cast("dict[str, Any]", parse_source(CELL, file="x").data)
    for edit in edits:
        made, refused = apply_cell_edits(texts[-1], [edit], file=str(file))
        if refused is not None:
            assert made == texts[-1]
            continue
        plain(expected, edit)
        assert parse_source(made, file="x").data == expected
        texts.append(made)
    draft = read_cell_draft(texts[-1], file=file, kind="cell")
    sections = [each for each in expected if each not in ("flexcell", "cell", "world")]
    assert {(each.section, each.name) for each in draft.items} == {
        (section, name) for section in sections for name in expected[section]
    }
    kept = [each for each in COMMENTS if each in texts[-1]]
    # What stands in an item goes with it when it is removed; everything else stays.
    gone = set(COMMENTS) - set(kept)
    assert gone <= {"# the table of 2019", "# measured", "# not the world"}
    if gone:
        assert any(isinstance(each, RemoveCellItem) for each in edits)


def _file(factory: Any) -> Path:
    folder: Path = factory.getbasetemp() / "random_cell"
    return folder / "behaviors" / "cells" / "bench.yaml" if folder.exists() else write_cell(folder)
