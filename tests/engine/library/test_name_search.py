"""Search by name: which names have the words of a text, and in which order."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from engine.library import NameHit, behavior_names, search_names
from tests.editor_web.fake_behaviors import BROKEN, TRANSFER

NAMES = [
    NameHit(kind="node", id="b", title="approach_grasp", detail="motion.MoveLinear · transfer"),
    NameHit(kind="node", id="b", title="Grasp", detail="gripper.Grasp · transfer"),
    NameHit(kind="node", id="b", title="grasp_again", detail="gripper.Grasp · transfer"),
    NameHit(kind="entry", id="home", title="home", detail="joints"),
]
TEXT = st.text(st.sampled_from("graspGRASP home·_xyz "), max_size=12)


def _titles(text: str, limit: int = 10) -> list[str]:
    return [name.title for name in search_names(text, NAMES, limit=limit)]


def test_the_name_itself_comes_first_then_those_that_begin_so() -> None:
    assert _titles("grasp") == ["Grasp", "grasp_again", "approach_grasp"]
    assert _titles("grasp", limit=1) == ["Grasp"]


def test_every_word_must_be_there_in_title_or_detail() -> None:
    assert _titles("transfer again") == ["grasp_again"]
    assert _titles("home transfer") == []
    assert _titles("  ") == []


def test_behaviors_come_with_their_nodes_and_unreadable_ones_without() -> None:
    names = list(behavior_names([TRANSFER, BROKEN]))
    assert [name.id for name in names if name.kind == "behavior"] == [TRANSFER.id, BROKEN.id]
    paths = {name.path for name in names if name.kind == "node" and name.id == TRANSFER.id}
    assert {"root/pick", "root/pick/left"} <= paths
    assert not [name for name in names if name.kind == "node" and name.id == BROKEN.id]


@given(TEXT, st.lists(st.builds(NameHit, kind=st.just("run"), id=TEXT, title=TEXT, detail=TEXT), max_size=8))
def test_what_is_found_has_all_words_and_nothing_that_has_them_is_left_out(text: str, names: list[NameHit]) -> None:
    words = text.lower().split()
    due = [n for n in names if words and all(word in f"{n.title}\0{n.detail}".lower() for word in words)]
    found = search_names(text, names, limit=100)
    assert sorted(map(repr, found)) == sorted(map(repr, due))
