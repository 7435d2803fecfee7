"""Userdata in trees: one scope for the tree, one for each branch of a parallel."""

from __future__ import annotations

from tests.engine.runtime.tree.run_tree import run_tree


def test_leaves_read_outward_and_write_where_the_key_lives() -> None:
    """What one leaf writes the next reads; a key that lives around the tree is written there."""
    told = run_tree(
        """
        sequence:
          - {state: test.Write, with: {value: 7}}
          - guard: {when: '${value == 7}', child: {state: test.Write, with: {value: 8}, out: {value: only_here}}}
          - guard: {when: '${only_here == 8}', child: {state: test.Check}}
        """,
        head="userdata: {value: 0}",
    )
    assert (told.result.outcome, told.result.userdata) == ("success", {"value": 7})


def test_branches_of_a_parallel_write_apart_and_are_merged_in_document_order() -> None:
    """The right one writes first; the order of the document decides."""
    told = run_tree(
        """
        parallel:
          - {state: test.Write, with: {value: left, after_s: 1}}
          - sequence:
              - {state: test.Write, with: {value: right}}
              - guard: {when: '${value == "right"}', child: {state: test.Check, with: {script: [[2, true]]}}}
        """,
        head="userdata: {value: 0}",
    )
    assert (told.result.outcome, told.result.userdata) == ("success", {"value": "right"})
    told = run_tree(
        """
        parallel:
          - {state: test.Write, with: {value: left, after_s: 2}}
          - {state: test.Write, with: {value: right, after_s: 1}}
        """,
        head="userdata: {value: 0}",
    )
    assert told.result.userdata == {"value": "right"}


def test_a_branch_does_not_see_what_another_writes() -> None:
    """Not before the parallel has ended."""
    told = run_tree(
        """
        sequence:
          - parallel:
              - {state: test.Write, with: {value: written}}
              - sequence:
                  - {state: test.Act, with: {script: [[1, true]]}}
                  - guard: {when: '${value == 0}', child: {state: test.Check}}
          - guard: {when: '${value == "written"}', child: {state: test.Check}}
        """,
        head="userdata: {value: 0}",
    )
    assert told.result.outcome == "success"


def test_a_parallel_that_is_halted_leaves_nothing_behind() -> None:
    """As a concurrency container that is preempted."""
    told = run_tree(
        """
        selector:
          - timeout:
              after: 1 s
              child: {parallel: [{state: test.Write, with: {value: written}}, {state: test.Hang}]}
          - {state: test.Check}
        """,
        head="userdata: {value: 0}",
    )
    assert told.result.userdata == {"value": 0}


def test_a_parallel_begins_with_fresh_branches_each_time() -> None:
    """What a branch wrote in the round before is merged, not kept apart."""
    told = run_tree(
        """
        repeat:
          times: 3
          child: {parallel: [{state: test.Count, success: [more, full], with: {up_to: 9}}, {state: test.Check}]}
        """,
        head="userdata: {count: 0}",
    )
    assert told.result.userdata == {"count": 3}
