"""The table of node kinds: complete, and true to the models."""

from __future__ import annotations

from typing import cast

import pytest

from engine.document import parse_behavior
from engine.document.nodes.node_kind import KINDS, WRAPPERS
from engine.document.nodes.node_kinds import NODE_KINDS, KindField
from engine.document.nodes.node_spec import TREE_KINDS

HEAD = "flexcell: 1\nname: t\noutcomes: [success, failure]\nroot:\n  tree:\n    "


def test_the_table_holds_all_kinds_but_those_without_children() -> None:
    """In the order of documents, those for machines first."""
    leaves = ("state", "behavior", "behaviour")
    assert tuple(NODE_KINDS) == tuple(key for key in (*KINDS, *TREE_KINDS, *WRAPPERS) if key not in leaves)


def test_a_form_shows_the_labelled_fields_of_the_model() -> None:
    """Under their keys in documents; a boolean is a switch."""
    assert NODE_KINDS["cooldown"].form == (KindField(key="after", label="After", hint="Such as 30 s", control="text"),)
    assert [field.control for field in NODE_KINDS["sequence"].form] == ["switch"]
    assert [field.key for field in NODE_KINDS["foreach"].form] == ["items", "times", "as", "index"]
    assert NODE_KINDS["remap"].form == ()


@pytest.mark.parametrize("key", [key for key, kind in NODE_KINDS.items() if kind.is_decorator])
def test_a_new_decorator_is_valid_with_a_child(key: str) -> None:
    """What the editor inserts lacks nothing but the child; the child is found again under its name."""
    new = cast("dict[str, object]", NODE_KINDS[key].new)
    text = f"{HEAD}{key}: {{{''.join(f'{name}: {value!r}, ' for name, value in new.items())}child: {{state: x.A}}}}\n"
    (node,) = parse_behavior(text, file="t.yaml").root.children.values()
    assert (node.kind, type(node.decorator), node.child_keys("A")) == (key, NODE_KINDS[key].model, (key, "child"))
