"""Putting containers around nodes and taking them away, line by line."""

from __future__ import annotations

from textwrap import indent

from tests.engine.editing.edit_fixtures import difference, edited, refusal
from tests.engine.editing.edits.test_node_edits import TEXT, TREE

HEAD = """\
flexcell: 1
name: chain
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: one
    states:
"""
CHAIN = (
    HEAD
    + """\
      one:   # 1
        state: flow.Wait
        with: {duration_s: 1}
        transitions: {done: two}
      two: {state: test.Give, transitions: {a: three, b: three, c: bad}}
      # Third.
      three:
        state: test.Give
        on_error: bad
        transitions: {a: good, b: good, c: bad}
view: {root/one: [100, 200], root/two: [300, 250]}
"""
)


def test_a_group_takes_its_text_along_and_leads_where_its_members_led() -> None:
    made = edited(CHAIN, {"edit": "group", "paths": ["root/two", "root/one"], "kind": "machine", "name": "pair"})
    moved = CHAIN[CHAIN.index("      one:") : CHAIN.index("      # Third.")]
    assert made == (
        HEAD.replace("initial: one", "initial: pair")
        + "      pair:\n        machine:\n          initial: one\n          states:\n"
        + indent(moved, "      ")
        + "        transitions: {three: three, bad: bad}\n"
        + CHAIN[CHAIN.index("      # Third.") : CHAIN.index("view:")]
        + "view: {root/pair/one: [40, 60], root/pair/two: [240, 110], root/pair: [60, 140]}\n"
    )


def test_a_group_that_would_fit_between_braces_keeps_the_comments_beside_its_members() -> None:
    ends = "transitions: {done: good}}"
    text = f"{HEAD}      # One.\n      one: {{state: flow.Wait, {ends}   # 1\n      two: {{state: flow.Wait, {ends}\n"
    made = edited(text, {"edit": "group", "paths": ["root/one"], "kind": "machine", "name": "group"})
    assert f"          states:\n            # One.\n            one: {{state: flow.Wait, {ends}   # 1\n" in made
    assert edited(made, {"edit": "ungroup", "path": "root/group"}) == text


def test_ungrouping_gives_the_text_back() -> None:
    made = edited(CHAIN, {"edit": "group", "paths": ["root/one", "root/two"], "kind": "machine", "name": "pair"})
    assert edited(made, {"edit": "ungroup", "path": "root/pair"}) == CHAIN


def test_a_chain_becomes_a_sequence_and_a_chain_again() -> None:
    made = edited(CHAIN, {"edit": "group", "paths": ["root/one", "root/two", "root/three"], "kind": "sequence"})
    assert made.startswith(
        HEAD.replace("initial: one", "initial: group")
        + """\
      group:
        tree:
          sequence:
            -   # 1
              name: one
              state: flow.Wait
              with: {duration_s: 1}
            - {name: two, state: test.Give}
            # Third.
            - name: three
              state: test.Give
              on_error: failure
        transitions: {success: good, failure: bad}
"""
    )
    back = edited(made, {"edit": "ungroup", "path": "root/group"})
    assert "transitions: {a: three, b: three, c: bad}" in back
    assert "        on_error: bad\n        transitions: {a: good, b: good, c: bad}\n" in back
    assert "initial: one" in back


def test_what_is_no_chain_is_no_sequence() -> None:
    text = CHAIN.replace("c: bad}}", "c: one}}")
    assert "has more than one next node" in refusal(
        text, {"edit": "group", "paths": ["root/one", "root/two", "root/three"], "kind": "sequence"}
    )
    text = CHAIN.replace("c: bad}\n", "c: worse}\n")
    assert "leads to `bad`, `worse`" in refusal(
        text, {"edit": "group", "paths": ["root/one", "root/two", "root/three"], "kind": "sequence"}
    )


def test_states_become_branches_and_their_good_ends_lead_on_together() -> None:
    made = edited(CHAIN, {"edit": "group", "paths": ["root/one", "root/three"], "kind": "concurrency"})
    assert "conditions" in made
    text = CHAIN.replace("{done: two}", "{done: three}").replace("{a: three, b: three, c: bad}", "{a: three, c: bad}")
    made = edited(text, {"edit": "group", "paths": ["root/one", "root/two"], "kind": "concurrency", "name": "both"})
    assert (
        """\
          conditions:
            - {three: {one: done, two: a}}
            - {three: {one: done, two: b}}
            - {bad: {two: c}}
        transitions: {three: three, bad: bad}
"""
        in made
    )


def test_a_group_is_entered_in_one_place() -> None:
    assert "`second` and `both` are all entered" in refusal(
        TEXT.replace("c: third}\n", "c: both}\n"),
        {"edit": "group", "paths": ["root/second", "root/both"], "kind": "machine"},
    )


def test_neighbours_in_a_tree_are_grouped_and_ungrouped() -> None:
    paths = ["root/sequence/Give", "root/sequence/Give_2"]
    made = edited(TREE, {"edit": "group", "paths": paths, "kind": "sequence", "name": "inner"})
    assert (
        """\
      - name: inner
        sequence:
          # One.
          - state: test.Give   # give
          - {state: test.Give, with: {after_s: 2}}
      - parallel:
"""
        in made
    )
    assert "view: {root/sequence/inner/Give_2: [1, 2]}" in made
    assert edited(made, {"edit": "ungroup", "path": "root/sequence/inner"}) == TREE
    far = [paths[0], "root/sequence/parallel"]
    assert "are not adjacent" in refusal(TREE, {"edit": "group", "paths": far, "kind": "selector"})


def test_a_branch_gets_a_machine_around_it() -> None:
    made = edited(TEXT, {"edit": "group", "paths": ["root/both/left"], "kind": "machine"})
    assert "conditions:\n            - {done: {left: a, right: a}}   # all well" in made
    assert "left: {state: test.Give, with: {after_s: 0.01}, transitions: {a: a, b: b, c: c}}" in made
    assert edited(made, {"edit": "ungroup", "path": "root/both/left"}) == TEXT
    many = ["root/both/left", "root/both/right"]
    assert "cannot be grouped" in refusal(TEXT, {"edit": "group", "paths": many, "kind": "machine"})


def test_what_would_be_lost_is_not_ungrouped() -> None:
    made = edited(CHAIN, {"edit": "group", "paths": ["root/one", "root/two"], "kind": "machine", "name": "pair"})
    made = edited(
        made, {"edit": "set_field", "path": "root/pair", "field": "timeout", "value": {"after": 1, "to": "bad"}}
    )
    assert "`timeout` of `root/pair` would be lost" in refusal(made, {"edit": "ungroup", "path": "root/pair"})
    assert "would change the behavior" in refusal(TEXT, {"edit": "ungroup", "path": "root/both"})


def test_duplicates_of_a_group_keep_their_comments_inside() -> None:
    made = edited(CHAIN, {"edit": "group", "paths": ["root/one", "root/two"], "kind": "machine", "name": "pair"})
    twice = edited(made, {"edit": "duplicate", "paths": ["root/pair"]})
    assert [line.strip("+ ") for line in difference(made, twice)][:2] == ["pair_2:", "machine:"]
    assert twice.count("# 1") == 2
