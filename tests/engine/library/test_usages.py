"""Where behaviors use a state, a behavior, an entry or a key: in every document, with line and way of use."""

from __future__ import annotations

from pathlib import Path

from engine.library import Usages
from engine.library.behavior_library import Library
from tests.engine.check.checking import CATALOGUE, HEAD

MOVE = """\
userdata: {tries: 0}
root:
  machine:
    initial: home
    states:
      home:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: home}}
        transitions: {reached: more, failed: bad}
      more:
        disabled: failed
        guard: {when: "${tries < 3}", to: bad}
        state: motion.MoveJoints
        with: {robot: left, target: {entry: away}}
        transitions: {reached: good, failed: bad}
"""
OUTER = """\
parameters: {pose: {type: string, default: home}}
userdata: {tries: 0, poses: []}
root:
  machine:
    initial: inner
    states:
      inner:
        behavior: move.yaml
        in: {tries: tries}
        out: {tries: tries}
        transitions: {good: learn, bad: bad}
      learn:
        state: motion.LearnJointDmp
        with: {robot: left, recording: home, save_as: home}
        transitions: {learned: loop, failed: bad}
      loop:
        foreach:
          items: ${poses}
          as: tries
          child: {state: motion.MoveJoints, with: {robot: left, target: {entry: "${pose}"}}}
        transitions: {exhausted: good, broken: bad}
"""


def _project(folder: Path) -> Library:
    (folder / "behaviors" / "inner").mkdir(parents=True)
    texts = {"behaviors/move.yaml": HEAD + MOVE, "behaviors/outer.yaml": HEAD + OUTER, "behaviors/broken.yaml": "a: ["}
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return Library(folder, CATALOGUE)


def _places(found: Usages) -> list[str]:
    return [" ".join(f"{Path(use.document).stem}:{use.line} {use.path} {use.how}".split()) for use in found.found]


def test_a_state_is_found_in_all_documents_also_where_it_is_disabled(tmp_path: Path) -> None:
    found = _project(tmp_path).usages("state", "motion.MoveJoints")
    assert _places(found) == [
        "move:11 root/home runs",
        "move:17 root/more runs",
        "outer:24 root/loop/child runs",
    ]
    assert found.unread == ("behaviors/broken.yaml",)


def test_a_document_with_mistakes_is_looked_at_as_far_as_it_can_be_read(tmp_path: Path) -> None:
    library = _project(tmp_path)
    text = HEAD + MOVE.replace("initial: home", "initial: nowhere") + "more: 1\n"
    (tmp_path / "behaviors" / "half.yaml").write_text(text, encoding="utf-8")
    found = library.usages("state", "motion.MoveJoints")
    assert [place for place in _places(found) if "half" in place] == [
        "half:11 root/home runs",
        "half:17 root/more runs",
    ]


def test_a_behavior_is_found_by_its_id_and_not_by_how_it_is_written(tmp_path: Path) -> None:
    library = _project(tmp_path)
    assert _places(library.usages("behavior", "behaviors/move.yaml")) == ["outer:12 root/inner refers to it"]
    assert _places(library.usages("behavior", "move.yaml")) == []


def test_an_entry_is_found_where_it_is_read_and_where_it_is_written(tmp_path: Path) -> None:
    library = _project(tmp_path)
    places = _places(library.usages("entry", "home"))
    assert places[0].startswith("move:12 root/home reads")
    assert "outer:18 root/learn writes" in places
    assert "outer:24 root/loop/child reads joints, the default of `pose`" in places
    assert [place.split(" ")[:2] for place in _places(library.usages("entry", "away"))] == [["move:18", "root/more"]]


def test_a_key_is_found_where_it_is_declared_read_written_and_passed_on(tmp_path: Path) -> None:
    assert _places(_project(tmp_path).usages("key", "tries")) == [
        "move:5 declares",
        "move:16 root/more reads",
        "outer:6 declares",
        "outer:13 root/inner reads",
        "outer:14 root/inner writes",
        "outer:23 root/loop declares",
    ]


def test_what_nobody_uses_has_no_usages(tmp_path: Path) -> None:
    library = _project(tmp_path)
    for kind in ("state", "behavior", "entry", "key"):
        assert library.usages(kind, "nothing").found == ()
