"""Entries documents: what they hold, and that they can be written and read back."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.entries_document import load_entries, write_entries
from engine.errors import DocumentError
from engine.skills.entries import EntryRecord

TEXT = """flexcell: 1
joints:
  left_home: [0, -0.5, 1]
poses:
  left/above: {xyz: [0.4, 0, 0.3], xyzw: [1, 0, 0, 0]}
dmps:
  pour: {N: 2}
cart_dmps:
  wipe: {N: 3}
cart_offsets:
  pressed: {c_o: [1]}
trajectories:
  led: {times_s: [0, 1]}
grippers:
  closed: {width_m: 0.03, held: true}
detections:
  gear: {detector: blobs}
records:
  tray: {rows: 4}
"""

VALUES = st.dictionaries(
    st.text("abc_", min_size=1, max_size=4),
    st.integers().filter(lambda n: abs(n) < 2**63) | st.text("ab: #'\"", max_size=5),
)
NAMES = st.from_regex("[a-z][a-z0-9_/.-]{0,12}", fullmatch=True)


def test_each_section_gives_records_of_its_kind(tmp_path: Path) -> None:
    """In the form that a store takes."""
    file = tmp_path / "entries.yaml"
    file.write_text(TEXT, encoding="utf-8")
    entries = load_entries(file)
    pose = {"xyz": [0.4, 0.0, 0.3], "xyzw": [1.0, 0.0, 0.0, 0.0], "frame": "world"}
    assert [(r.kind, r.name, r.value) for r in entries.records()] == [
        ("joints", "left_home", {"joints": [0.0, -0.5, 1.0]}),
        ("pose", "left/above", pose),
        ("dmp", "pour", {"N": 2}),
        ("cart_dmp", "wipe", {"N": 3}),
        ("cart_offsets", "pressed", {"c_o": [1]}),
        ("trajectory", "led", {"times_s": [0, 1]}),
        ("gripper", "closed", {"width_m": 0.03, "held": True}),
        ("detection", "gear", {"detector": "blobs"}),
        ("record", "tray", {"rows": 4}),
    ]
    assert entries.names() == {"left_home", "left/above", "pour", "wipe", "pressed", "led", "closed", "gear", "tray"}
    assert write_entries(entries.records()) == write_entries(reversed(entries.records()))
    assert entries.names_by_kind()["cart_dmp"] == {"wipe"}


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("[0, -0.5, 1]", "[]", "3:14: `left_home`: expected list of length >= 1"),
        ("[0, -0.5, 1]", "[0, up]", "3:18: `left_home`: expected number, got text"),
        ("[1, 0, 0, 0]", "[1, 1, 0, 0]", "5:42: the quaternion of `left/above` has length 1.414"),
        ("[1, 0, 0, 0]", "[1, 0, 0]", "5:42: `xyzw`: expected list of length 4"),
        ("left_home", "Left", "3:3: `Left`: not in the allowed form"),
        ("poses", "pose", "4:1: unknown key `pose` (did you mean poses"),
        ("flexcell: 1\n", "", "the key `flexcell` is missing"),
    ],
)
def test_a_wrong_entry_is_refused_where_it_stands(tmp_path: Path, old: str, new: str, says: str) -> None:
    """With line and column."""
    file = tmp_path / "entries.yaml"
    file.write_text(TEXT.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(DocumentError) as refusal:
        load_entries(file)
    assert says in str(refusal.value)


@given(
    joints=st.dictionaries(NAMES, st.lists(st.floats(-7, 7), min_size=1, max_size=7), max_size=3),
    records=st.dictionaries(NAMES, VALUES, max_size=3),
)
def test_entries_written_are_read_back(
    tmp_path_factory: pytest.TempPathFactory, joints: dict[str, list[float]], records: dict[str, dict[str, object]]
) -> None:
    """Whatever their order; the text is the same each time."""
    given_records = [
        *(EntryRecord(kind="joints", name=n, value={"joints": v}, revision=0) for n, v in joints.items()),
        *(EntryRecord(kind="record", name=n, value=v, revision=0) for n, v in records.items()),
    ]
    text = write_entries(given_records)
    file = tmp_path_factory.mktemp("entries") / "entries.yaml"
    file.write_text(text, encoding="utf-8")
    read = load_entries(file).records()
    assert sorted(read, key=lambda r: (r.kind, r.name)) == sorted(given_records, key=lambda r: (r.kind, r.name))
    assert write_entries(reversed(given_records)) == text


def test_tags_and_the_names_of_joints_are_written_and_read_back(tmp_path: Path) -> None:
    """What no tags are said of keeps those it has."""
    named: dict[str, object] = {"joints": [0.0, 1.0], "names": ["a", "b"], "model": "panda"}
    records = [
        EntryRecord(kind="joints", name="home", value={"joints": [0.5], "names": [], "model": ""}, revision=3, tags=()),
        EntryRecord(kind="joints", name="led", value=named, revision=1, tags=("fast", "tested")),
        EntryRecord(kind="record", name="led", value={"n": 1}, revision=1, tags=("tested",)),
    ]
    text = write_entries(records)
    assert text.splitlines()[1:] == [
        "joints:",
        "  home: [0.5]",
        "  led:",
        "    joints: [0.0, 1.0]",
        "    names: [a, b]",
        "    model: panda",
        "records:",
        "  led: {n: 1}",
        "tags:",
        "  joints:",
        "    led: [fast, tested]",
        "  records:",
        "    led: [tested]",
    ]
    file = tmp_path / "entries.yaml"
    file.write_text(text, encoding="utf-8")
    assert [(r.value, r.tags) for r in load_entries(file).records()] == [
        ({"joints": [0.5]}, None),
        (named, ("fast", "tested")),
        ({"n": 1}, ("tested",)),
    ]


@pytest.mark.parametrize(
    ("tags", "says"),
    [
        ("tags: {joints: {left_hme: [a]}}", "20:17: there is no `left_hme` under `joints` (did you mean left_home"),
        ("tags: {cloud: {a: [b]}}", "20:8: "),
        ("tags: {joints: {left_home: [No]}}", "20:29: `left_home`: not in the allowed form"),
    ],
)
def test_tags_of_what_is_not_there_are_refused(tmp_path: Path, tags: str, says: str) -> None:
    """With line and column."""
    file = tmp_path / "entries.yaml"
    file.write_text(f"{TEXT}{tags}\n", encoding="utf-8")
    with pytest.raises(DocumentError) as refusal:
        load_entries(file)
    assert says in str(refusal.value)


def test_a_kind_without_section_is_refused() -> None:
    """Nothing is dropped silently."""
    with pytest.raises(DocumentError, match="entries of kind `cloud` cannot be written"):
        write_entries([EntryRecord(kind="cloud", name="x", value={}, revision=1)])
