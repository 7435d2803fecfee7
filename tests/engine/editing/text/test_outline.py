"""The targets of a node, also of one that is not valid."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from engine.editing.text.outline import targets_of, transition_entries

TARGETS = st.sampled_from(["a", "b", 3, None])
MAPPINGS = st.one_of(TARGETS, st.dictionaries(st.sampled_from(["done", "to", "after"]), TARGETS))


@given(st.dictionaries(st.sampled_from(["transitions", "timeout", "guard", "on_error", "state"]), MAPPINGS))
def test_the_targets_of_a_node_are_those_of_its_entries(node: dict[str, object]) -> None:
    assert targets_of(node) == [target for _, _, target in transition_entries(node)]
