"""Scopes: read outward, write where the key lives, branches apart."""

from __future__ import annotations

from typing import cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import UserdataError
from engine.runtime.userdata.userdata import Scope

keys = st.sampled_from("abc")
values = st.integers() | st.lists(st.integers(), max_size=3) | st.text(max_size=3)


def test_a_write_goes_to_the_nearest_scope_that_has_the_key() -> None:
    """An inner state changes an outer key; a new key stays inside."""
    outer = Scope("root", {"part": 1})
    inner = Scope("root/inner", {}, outer)
    assert (inner.write("part", 2), inner.write("new", 3)) == ("root", "root/inner")
    assert (outer.own_values(), inner.own_values()) == ({"part": 2}, {"new": 3})


def test_a_branch_keeps_its_writes_until_they_are_merged() -> None:
    """A sibling never sees half of it."""
    outer = Scope("root", {"part": 1})
    branch = Scope("root", {}, outer, isolated=True)
    deeper = Scope("root/left", {}, branch)
    deeper.write("part", 2)
    assert (outer.read("part", reader="t"), deeper.read("part", reader="t")) == (1, 2)


def test_a_missing_key_names_the_reader_and_near_keys() -> None:
    """The message says what to write instead."""
    with pytest.raises(UserdataError, match=r"root/x: userdata key 'prat' is read.*did you mean part\?"):
        Scope("root", {"part": 1}).read("prat", reader="root/x")


@given(st.lists(st.tuples(st.integers(0, 2), keys, values), max_size=20))
def test_nested_scopes_read_what_a_chain_of_mappings_would(writes: list[tuple[int, str, object]]) -> None:
    """Against a model: the value seen from the inside is the innermost one written."""
    scopes = [Scope("root", {"a": 0})]
    for depth in range(2):
        scopes.append(Scope(f"root/{depth}", {}, scopes[-1]))
    model: list[dict[str, object]] = [{"a": 0}, {}, {}]
    for depth, key, value in writes:
        scopes[depth].write(key, value)
        owner = next((d for d in range(depth, -1, -1) if key in model[d]), depth)
        model[owner][key] = value
    assert scopes[2].visible() == {**model[0], **model[1], **model[2]}


@given(values)
def test_what_a_reader_does_to_a_value_stays_with_the_reader(value: object) -> None:
    """Mutable values are copied on the way in and out."""
    scope = Scope("root", {"v": value})
    seen = scope.read("v", reader="t")
    if isinstance(seen, list):
        cast("list[int]", seen).append(1)
    assert scope.own_values() == {"v": value}
