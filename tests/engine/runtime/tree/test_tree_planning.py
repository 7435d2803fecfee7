"""What a document says of a tree is checked when it is read and planned, with positions."""

from __future__ import annotations

import pytest

from engine.errors import DocumentError
from engine.runtime.tree import Tree
from tests.engine.runtime.tree.run_tree import tree_plan


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        ("parallel: {policy: [b], children: [{state: test.Check, name: a}]}", "there is no child `b` here"),
        ("retry: {times: 2, outcomes: [no], child: {state: test.Check}}", "`retry` with a `child` has no `outcomes`"),
        ("{state: test.Check, success: [maybe]}", "`Check` has no outcome `maybe`"),
        ("guard: {when: '${1 +}', child: {state: test.Check}}", "Syntax error"),
        ("sequence: []", "length >= 1"),
        ("sequence: {memory: true}", "`children` is missing"),
        ("{state: test.Check, timeout: {after: 1 s, to: elsewhere}}", "needs a `to` that is a status"),
    ],
)
def test_what_is_wrong_is_said(tree: str, message: str) -> None:
    """Before anything runs."""
    with pytest.raises(DocumentError) as refused:
        tree_plan(tree)
    assert message in refused.value.message
    assert str(refused.value).startswith("test.yaml:")


def test_leaves_are_found_by_their_path_below_the_tree() -> None:
    """In document order; a name that is taken gets a number."""
    plan = tree_plan("""
        sequence:
          - {state: test.Check}
          - retry: {times: 1, child: {selector: [{state: test.Check}, {state: test.Act, name: act}]}}
          - {state: test.Check}
    """)
    work = plan.root.work
    assert isinstance(work, Tree)
    assert list(work.children) == [
        "sequence/Check", "sequence/retry/selector/Check", "sequence/retry/selector/act", "sequence/Check_2",
    ]  # fmt: skip
    assert [node.path for node in work.children.values()] == [f"root/{name}" for name in work.children]
