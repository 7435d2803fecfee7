"""`post` of a part assigns userdata when the part has ended, or was halted."""

from __future__ import annotations

import pytest

from engine.errors import DocumentError
from engine.event import UserdataWritten
from tests.engine.runtime.tree.run_tree import run_tree, tree_plan

HEAD = "userdata: {value: 0, count: 0, last: ''}"
POST = """
    post:
      on_success: {last: good, count: "${count + 1}"}
      on_failure: {last: bad}
      on_halted: {last: halted}
      always: {value: "${count * 10}"}
"""


@pytest.mark.parametrize(
    ("good", "expected"),
    [("true", {"last": "good", "count": 1, "value": 10}), ("false", {"last": "bad", "count": 0, "value": 0})],
)
@pytest.mark.parametrize("part", ["state: test.Act\n    with: {script: [[1, <good>]]}", "sequence: [{<leaf>}]"])
def test_it_assigns_what_belongs_to_its_end(part: str, good: str, expected: dict[str, object]) -> None:
    """In the order of the document, each with what those before have written, and what is always due at last."""
    leaf = "state: test.Act, with: {script: [[1, <good>]]}"
    tree = f"sequence:\n  - {part.replace('<leaf>', leaf).replace('<good>', good)}{POST}"
    told = run_tree(tree, head=HEAD)
    assert told.result.userdata == expected
    assert told.result.outcome == ("success" if good == "true" else "failure")


def test_what_comes_next_reads_what_was_assigned() -> None:
    """The sequence goes on with the new value."""
    told = run_tree(
        """
        sequence:
          - {state: test.Act, post: {on_success: {value: 7}}}
          - {state: test.Act, name: a, guard: {when: "${value == 7}", to: failure}}
        """,
        head=HEAD,
    )
    assert told.result.outcome == "success"


def test_what_is_halted_assigns_that_and_nothing_else() -> None:
    """The first that ends stops the other; one that never began, or is skipped, assigns nothing."""
    told = run_tree(
        """
        parallel:
          policy: one
          children:
            - {state: test.Act, name: a, with: {script: [[1, true]]}}
            - state: test.Act
              name: b
              with: {script: [[9, true]], cleanup_s: 1}
              post: {on_halted: {last: halted}, on_success: {value: 1}, always: {value: 2}}
            - sequence: [{state: test.Act, name: c, with: {script: [[9, true]]}}]
              post: {on_halted: {count: "${count + 1}"}}
            - state: test.Act
              name: d
              guard: {when: "${value == 1}", to: skipped}
              post: {on_success: {value: 3}, on_failure: {value: 3}, on_halted: {value: 3}, always: {value: 3}}
        """,
        head=HEAD,
    )
    assert told.result.userdata == {"value": 0, "count": 1, "last": "halted"}


def test_a_tree_that_is_stopped_halts_what_is_in_it() -> None:
    """Once for each part, and a value that cannot be had does not keep it from ending."""
    tree = """
        sequence:
          - {state: test.Act, with: {script: [[9, true]]}, post: {on_halted: {count: "${count + 1}"}}}
          - {state: test.Act, name: never, post: {on_halted: {count: "${count + 1}"}}}
        post: {on_halted: {value: "${1 / value}"}}
        """
    told = run_tree(tree, head=HEAD, stop_at_s=1.0)
    assert told.result.status == "stopped"
    assert [event.key for event in told.events if isinstance(event, UserdataWritten)] == ["count"]
    assert any("post-condition failed" in line for line in told.lines)


def test_a_value_that_cannot_be_had_is_an_error_of_the_part() -> None:
    """Which a retry around it takes."""
    failing = "{state: test.Act, post: {on_success: {value: '${1 / value}'}}}"
    told = run_tree(f"sequence: [{failing}]", head=HEAD)
    assert told.result.status == "errored"
    told = run_tree(f"retry: {{times: 1, child: {failing}}}", head=HEAD)
    assert (told.result.status, told.entered("Act")) == ("errored", [0.0, 0.0])


def test_post_conditions_stand_in_trees_only() -> None:
    """Elsewhere a transition leads to a state that writes."""
    state = "{state: test.Act, post: {always: {x: 1}}, transitions: {yes: x, no: x}}"
    with pytest.raises(DocumentError, match="`post` of a node is only allowed inside a tree"):
        tree_plan(f"machine: {{initial: a, states: {{a: {state}}}}}")
