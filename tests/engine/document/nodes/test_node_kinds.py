"""The table of node kinds: complete, and true to the models."""

from __future__ import annotations

from typing import cast

import pytest

from engine.document import parse_behavior
from engine.document.nodes.node_kind import KINDS, WRAPPERS
from engine.document.nodes.node_kinds import LEAF_ICONS, NODE_KINDS, KindField, node_icon
from engine.document.nodes.node_spec import TREE_KINDS
from engine.state import State
from states import CATALOGUE

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


def test_every_kind_has_an_icon_of_its_own() -> None:
    """A kind is recognised by it, also among the leaves; a behaviour of py_trees is a state of another library."""
    icons = [*(kind.icon for kind in NODE_KINDS.values()), LEAF_ICONS["state"], LEAF_ICONS["behavior"]]
    assert len(set(icons)) == len(icons)
    assert LEAF_ICONS.keys() | NODE_KINDS.keys() == {*KINDS, *TREE_KINDS, *WRAPPERS}
    assert node_icon("cooldown") == NODE_KINDS["cooldown"].icon
    assert node_icon("unheard_of") == LEAF_ICONS["state"]


class Plain(State, frozen=True, kw_only=True):
    """A state of a module that names no icon."""


def test_a_state_has_the_icon_of_its_package_unless_it_has_one_itself() -> None:
    named = {
        name: node_icon("state", CATALOGUE[name]) for name in ("gripper.Grasp", "gripper.Open", "motion.PlanMotion")
    }
    assert named == {"gripper.Grasp": "gripper", "gripper.Open": "gripper", "motion.PlanMotion": "plan"}
    assert node_icon("state", CATALOGUE["motion.MoveFree"]) == "path"
    assert node_icon("state", Plain) == LEAF_ICONS["state"]


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_standard_state_has_an_icon(name: str) -> None:
    assert node_icon("state", CATALOGUE[name]) != LEAF_ICONS["state"]
