"""Adding, removing, renaming, moving and duplicating nodes, line by line."""

from __future__ import annotations

import pytest

from engine.document import parse_behavior
from tests.engine.editing.edit_fixtures import changed, difference, edited, refusal

TEXT = """\
flexcell: 1
name: shift # what people call it
outcomes: [good, bad]
success: [good]

root:
  machine:
    initial: first
    states:
      # Above the first.
      first:   # behind the first
        state: test.Give
        with: {after_s: 1}
        transitions: {a: second, b: bad, c: third}
        timeout: {after: 5 s, to: second}

      # Above the second,
      # two lines.
      second:
        state: "test.Give"
        transitions:
          a: both   # onward
          b: bad
          c: bad
      both:
        concurrency:
          states:
            left: {state: test.Give, with: {after_s: 0.01}}
            right: {state: test.Give}   # the other arm
          conditions:
            - {done: {left: a, right: a}}   # all well
            - {odd: {left: b}}
            - {odd: {right: b}}
          otherwise: odd
        transitions: {done: third, odd: bad}
      third: {state: test.Give, transitions: {a: good, b: bad, c: bad}}
# Positions.
view:
  root/first: [0, 0]   # corner
  root/both/left: [10, 20]
  root/both: [5, 6]
"""
TREE = """\
flexcell: 1
name: tree
outcomes: [success, failure]
success: [success]
root:
  tree:
    sequence:
      # One.
      - state: test.Give   # give
      - {state: test.Give, with: {after_s: 2}}
      - parallel:
          policy: [Give_2]
          children:
            - state: test.Give
            # The one that counts.
            - state: test.Give
view: {root/sequence/Give_2: [1, 2]}
"""


def test_a_renamed_state_is_followed_by_all_that_names_it() -> None:
    made = edited(TEXT, {"edit": "rename_node", "path": "root/second", "name": "again"})
    assert difference(TEXT, made) == [
        "-        transitions: {a: second, b: bad, c: third}",
        "-        timeout: {after: 5 s, to: second}",
        "+        transitions: {a: again, b: bad, c: third}",
        "+        timeout: {after: 5 s, to: again}",
        "-      second:",
        "+      again:",
    ]
    assert edited(made, {"edit": "rename_node", "path": "root/again", "name": "second"}) == TEXT


def test_a_renamed_initial_state_stays_the_initial_one() -> None:
    made = edited(TEXT, {"edit": "rename_node", "path": "root/first", "name": "begin"})
    assert difference(TEXT, made) == [
        "-    initial: first",
        "+    initial: begin",
        "-      first:   # behind the first",
        "+      begin:   # behind the first",
        "-  root/first: [0, 0]   # corner",
        "+  root/begin: [0, 0]   # corner",
    ]


def test_a_renamed_branch_is_followed_by_conditions_and_positions() -> None:
    made = edited(TEXT, {"edit": "rename_node", "path": "root/both/left", "name": "west"})
    assert difference(TEXT, made) == [
        "-            left: {state: test.Give, with: {after_s: 0.01}}",
        "+            west: {state: test.Give, with: {after_s: 0.01}}",
        "-            - {done: {left: a, right: a}}   # all well",
        "-            - {odd: {left: b}}",
        "+            - {done: {west: a, right: a}}   # all well",
        "+            - {odd: {west: b}}",
        "-  root/both/left: [10, 20]",
        "+  root/both/west: [10, 20]",
    ]


def test_a_renamed_container_takes_the_positions_inside_along() -> None:
    made = edited(TEXT, {"edit": "rename_node", "path": "root/both", "name": "arms"})
    assert "root/arms/left: [10, 20]\n  root/arms: [5, 6]\n" in made
    assert "a: arms   # onward" in made


def test_a_name_that_is_taken_is_refused() -> None:
    assert "has a `third` already" in refusal(TEXT, {"edit": "rename_node", "path": "root/second", "name": "third"})
    assert "is an outcome" in refusal(TEXT, {"edit": "rename_node", "path": "root/second", "name": "bad"})
    assert "no node" in refusal(TEXT, {"edit": "rename_node", "path": "root/nobody", "name": "x"})


def test_a_removed_state_takes_its_comments_and_what_leads_to_it_along() -> None:
    made = edited(TEXT, {"edit": "remove_nodes", "paths": ["root/second"]})
    assert difference(TEXT, made) == [
        "-        transitions: {a: second, b: bad, c: third}",
        "+        transitions: {b: bad, c: third}",
        "-",
        "-      # Above the second,",
        "-      # two lines.",
        "-      second:",
        '-        state: "test.Give"',
        "-        transitions:",
        "-          a: both   # onward",
        "-          b: bad",
        "-          c: bad",
    ]


def test_a_removed_branch_leaves_the_conditions_of_the_others() -> None:
    made = edited(TEXT, {"edit": "remove_nodes", "paths": ["root/both/right"]})
    assert difference(TEXT, made) == [
        "-            right: {state: test.Give}   # the other arm",
        "-            - {done: {left: a, right: a}}   # all well",
        "+            - {done: {left: a}}   # all well",
        "-            - {odd: {right: b}}",
    ]


def test_a_count_of_branches_follows_those_that_are_left() -> None:
    some = TEXT.replace("right: a}}   # all well", "right: a, at_least: 1}}   # one of them")
    made = edited(some, {"edit": "rename_node", "path": "root/both/left", "name": "west"})
    assert "- {done: {west: a, right: a, at_least: 1}}   # one of them" in made
    two = some.replace("at_least: 1}}   # one", "at_least: 2}}   # both")
    made = edited(two, {"edit": "remove_nodes", "paths": ["root/both/right"]})
    assert "- {done: {left: a}}   # both of them" in made


def test_those_that_a_condition_preempts_are_renamed_and_removed_with_their_branches() -> None:
    """A condition that preempts nobody any more, or asks for nobody, goes."""
    some = TEXT.replace("- {odd: {right: b}}", "- {preempt: [left], when: {right: b}}   # too late")
    made = edited(some, {"edit": "rename_node", "path": "root/both/left", "name": "west"})
    assert "- {preempt: [west], when: {right: b}}   # too late" in made
    made = edited(some, {"edit": "rename_node", "path": "root/both/right", "name": "east"})
    assert "- {preempt: [left], when: {east: b}}   # too late" in made
    for gone in ("left", "right"):
        assert "too late" not in edited(some, {"edit": "remove_nodes", "paths": [f"root/both/{gone}"]})


def test_the_last_state_may_be_removed_and_another_one_added() -> None:
    paths = ["root/first", "root/second", "root/both", "root/third"]
    made = edited(TEXT, {"edit": "remove_nodes", "paths": paths})
    assert "  machine:\n    states: {}" in made
    assert "view" not in made
    again = edited(made, {"edit": "add_node", "parent": "root", "kind": "state", "runs": "test.Give"})
    assert "    initial: give\n    states:" in again
    assert "      give:\n        state: test.Give\n" in again


def test_a_new_state_is_written_like_its_neighbours() -> None:
    add = {"edit": "add_node", "parent": "root", "kind": "state", "runs": "test.Give", "parameters": {"after_s": 2.5}}
    assert difference(TEXT, edited(TEXT, add)) == [
        "+      give:",
        "+        state: test.Give",
        "+        with: {after_s: 2.5}",
    ]
    assert difference(TEXT, edited(TEXT, {**add, "parent": "root/both", "name": "arm"})) == [
        "+            arm: {state: test.Give, with: {after_s: 2.5}}",
    ]


def test_a_new_state_in_an_arrow_is_led_to_and_leads_on() -> None:
    add = {"edit": "add_node", "parent": "root", "kind": "state", "runs": "flow.Wait", "parameters": {"duration_s": 1}}
    made = edited(TEXT, {**add, "on_edge": {"from": "root/second", "outcome": "a"}, "position": [7.04, 8]})
    assert difference(TEXT, made) == [
        "-          a: both   # onward",
        "+          a: wait   # onward",
        "+      wait:",
        "+        state: flow.Wait",
        "+        with: {duration_s: 1}",
        "+        transitions: {done: both}",
        "+  root/wait: [7, 8]",
    ]


def test_a_new_state_after_another_one_is_led_to_by_its_open_good_outcomes() -> None:
    text = edited(TEXT, {"edit": "clear_transition", "path": "root/second", "outcome": "a"})
    made = edited(text, {"edit": "add_node", "parent": "root", "kind": "machine", "after": "root/second"})
    assert difference(TEXT, made) == [
        "-          a: both   # onward",
        "+          a: machine",
        "+      machine:",
        "+        machine: {states: {}}",
    ]


@pytest.mark.parametrize("kind", ["machine", "priority", "concurrency", "tree", "foreach"])
def test_containers_are_added_empty_and_filled(kind: str) -> None:
    text = edited(TEXT, {"edit": "add_node", "parent": "root", "kind": kind, "name": "inner"})
    inside = "root/inner/sequence" if kind == "tree" else "root/inner"
    made = edited(text, {"edit": "add_node", "parent": inside, "kind": "state", "runs": "test.Give"})
    name = {"foreach": "child", "tree": "Give"}.get(kind, "give")
    assert changed(text, {"edit": "add_node", "parent": inside, "kind": "state", "runs": "test.Give"}) == (
        f"{inside}/{name}",
    )
    assert made.startswith(TEXT.split("# Positions.", maxsplit=1)[0])


def test_decorators_are_added_and_take_one_child() -> None:
    text = edited(TREE, {"edit": "add_node", "parent": "root/sequence", "kind": "retry", "index": 0})
    made = edited(text, {"edit": "add_node", "parent": "root/sequence/retry", "kind": "state", "runs": "test.Give"})
    assert "retry:\n          times: 1\n          child:\n            state: test.Give\n" in made
    assert "one child only" in refusal(
        made, {"edit": "add_node", "parent": "root/sequence/retry", "kind": "state", "runs": "test.Give"}
    )
    assert "only inside a tree" in refusal(TEXT, {"edit": "add_node", "parent": "root", "kind": "retry"})


def test_parts_of_a_tree_that_have_no_name_keep_their_positions_and_policies() -> None:
    """Another child in front makes `Give_2` of what was `Give`, and what names it follows."""
    made = edited(
        TREE, {"edit": "add_node", "parent": "root/sequence", "kind": "state", "runs": "test.Give", "index": 0}
    )
    assert difference(TREE, made) == [
        "+      - state: test.Give",
        "-view: {root/sequence/Give_2: [1, 2]}",
        "+view: {root/sequence/Give_3: [1, 2]}",
    ]
    made = edited(TREE, {"edit": "remove_nodes", "paths": ["root/sequence/parallel/Give"]})
    assert difference(TREE, made) == [
        "-          policy: [Give_2]",
        "+          policy: [Give]",
        "-            - state: test.Give",
    ]
    made = edited(TREE, {"edit": "rename_node", "path": "root/sequence/parallel/Give_2", "name": "main"})
    assert difference(TREE, made) == [
        "-          policy: [Give_2]",
        "+          policy: [main]",
        "-            - state: test.Give",
        "+            - name: main",
        "+              state: test.Give",
    ]


def test_children_are_reordered_with_their_comments() -> None:
    made = edited(TREE, {"edit": "move_nodes", "paths": ["root/sequence/Give"], "parent": "root/sequence", "index": 1})
    assert "      - {state: test.Give, with: {after_s: 2}}\n      # One.\n      - state: test.Give   # give\n" in made
    made = edited(
        TEXT, {"edit": "set_field", "path": "root", "field": "order", "value": ["third", "second", "first", "both"]}
    )
    assert (
        made.index("third:") < made.index("# Above the second") < made.index("first:   # behind") < made.index("both:")
    )
    assert edited(
        made, {"edit": "set_field", "path": "root", "field": "order", "value": ["first", "second", "both", "third"]}
    ).replace("\n\n", "\n") == TEXT.replace("\n\n", "\n")


def test_moved_states_keep_their_text_and_the_transitions_among_them() -> None:
    text = edited(TEXT, {"edit": "add_node", "parent": "root", "kind": "machine", "name": "inner"})
    made = edited(text, {"edit": "move_nodes", "paths": ["root/second", "root/both"], "parent": "root/inner"})
    inner = made[made.index("      inner:") : made.index("# Positions")]
    assert inner.startswith(
        "      inner:\n        machine:\n          initial: second\n          states:\n"
        "            # Above the second,\n            # two lines.\n            second:\n"
        '              state: "test.Give"\n              transitions:\n                a: both   # onward\n'
    )
    assert "right: {state: test.Give}   # the other arm" in inner
    assert "root/inner/both/left: [10, 20]" in made
    assert "transitions: {b: bad, c: third}" in made
    assert "timeout: {after: 5 s, to: second}" in made  # a measure is not dropped in silence: the check tells of it


def test_a_state_moved_into_a_concurrency_container_has_no_transitions_there() -> None:
    made = edited(TEXT, {"edit": "move_nodes", "paths": ["root/second"], "parent": "root/both", "index": 0})
    assert '            # two lines.\n            second:\n              state: "test.Give"\n            left:' in made


def test_a_state_moved_into_a_tree_keeps_its_name_there() -> None:
    text = edited(TEXT, {"edit": "add_node", "parent": "root", "kind": "tree", "name": "plan"})
    made = edited(text, {"edit": "move_nodes", "paths": ["root/first"], "parent": "root/plan/sequence"})
    assert "            # Above the first.\n            -   # behind the first\n              name: first\n" in made
    assert "timeout: {after: 5 s, to: failure}" in made
    assert "initial: second" in made


def test_a_container_is_not_moved_into_itself() -> None:
    assert "into itself" in refusal(TEXT, {"edit": "move_nodes", "paths": ["root/both"], "parent": "root/both"})


def test_duplicates_stand_beside_and_lead_to_one_another() -> None:
    made = edited(TEXT, {"edit": "duplicate", "paths": ["root/first", "root/second"]})
    assert (
        difference(TEXT, made)
        == [
            "+      # Above the second,",
            "+      # two lines.",
            "+      second_2:",
            '+        state: "test.Give"',
            "+        transitions:",
            "+          a: both   # onward",
            "+          b: bad",
            "+          c: bad",
        ]
        or "first_2:" in made
    )
    assert "transitions: {a: second_2, b: bad, c: third}" in made
    assert "timeout: {after: 5 s, to: second_2}" in made
    assert "root/first_2: [40, 40]" in made


BRANCHING = """\
flexcell: 1
name: tree
outcomes: [success, failure]
success: [success]
root:
  tree:
    sequence:
      - if_then_else:
          # Asked once.
          if: {state: test.Give}
          then: {state: test.Give, with: {after_s: 2}}   # if so
      - {state: test.Give, name: last}
"""
IF = "root/sequence/if_then_else"


def test_a_new_child_of_a_branching_takes_the_role_that_is_free() -> None:
    made = edited(BRANCHING, {"edit": "add_node", "parent": IF, "kind": "state", "runs": "flow.Log"})
    assert difference(BRANCHING, made) == ["+          else: {state: flow.Log}"]
    added = {"edit": "add_node", "parent": IF, "kind": "state", "runs": "flow.Log"}
    assert refusal(made, added) == f"`{IF}` is full: none of its roles is free"
    emptied = edited(made, {"edit": "remove_nodes", "paths": [f"{IF}/Give_2"]})
    assert difference(made, emptied) == ["-          then: {state: test.Give, with: {after_s: 2}}   # if so"]
    filled = edited(emptied, {"edit": "move_nodes", "paths": ["root/sequence/last"], "parent": IF})
    assert "          then: {state: test.Give, name: last}\n          else: {state: flow.Log}\n" in filled


def test_a_branching_is_made_from_nothing() -> None:
    text = edited(
        "flexcell: 1\nname: t\noutcomes: [success, failure]\nroot:\n  tree: {}\n",
        {"edit": "add_node", "parent": "root", "kind": "while_do_else"},
        *({"edit": "add_node", "parent": "root/while_do_else", "kind": "state", "runs": "test.Give"} for _ in range(3)),
    )
    assert list(parse_behavior(text, file="t.yaml").root.children["while_do_else"].children) == [
        "Give",
        "Give_2",
        "Give_3",
    ]


def test_the_roles_of_a_branching_are_exchanged_by_order() -> None:
    made = edited(BRANCHING, {"edit": "set_field", "path": IF, "field": "order", "value": ["Give_2", "Give"]})
    assert "if: {state: test.Give, with: {after_s: 2}}" in made
    assert "then: {state: test.Give}" in made


def test_one_child_of_a_branching_is_grouped_and_ungrouped_in_its_role() -> None:
    made = edited(BRANCHING, {"edit": "group", "paths": [f"{IF}/Give_2"], "kind": "sequence"})
    node = parse_behavior(made, file="t.yaml").root.children["sequence"].children["if_then_else"]
    assert [child.kind for child in node.children.values()] == ["state", "sequence"]
    assert edited(made, {"edit": "ungroup", "path": f"{IF}/sequence"}) == BRANCHING
    both = {"edit": "group", "paths": [f"{IF}/Give", f"{IF}/Give_2"], "kind": "sequence"}
    assert refusal(BRANCHING, both) == "the children of a if_then_else have roles"
    assert "changes its meaning" in refusal(BRANCHING, {"edit": "ungroup", "path": IF})


def test_a_guard_that_skips_is_kept_within_a_tree_and_not_taken_into_a_machine() -> None:
    guarded = BRANCHING.replace("name: last}", "name: last, guard: {when: '${true}', to: skipped}}")
    moved = edited(guarded, {"edit": "move_nodes", "paths": ["root/sequence/last"], "parent": IF})
    assert "else: {state: test.Give, name: last, guard: {when: '${true}', to: skipped}}" in moved
    text = (
        "flexcell: 1\nname: t\noutcomes: [good, bad]\nroot:\n  machine:\n    initial: tree\n    states:\n      tree:\n"
    )
    tree = "{tree: {sequence: [{state: flow.Wait, with: {duration_s: 1}, guard: {when: '${true}', to: skipped}}]}"
    machine = f"{text}        {tree}, transitions: {{success: good, failure: bad}}}}\n".replace(
        "tree:\n        {", "tree: {"
    )
    assert "may be skipped" in refusal(machine, {"edit": "ungroup", "path": "root/tree"})


def test_post_conditions_are_set_and_left_behind_outside_of_trees() -> None:
    post = {"on_success": {"count": "${count + 1}"}}
    made = edited(TREE, {"edit": "set_field", "path": "root/sequence/Give_2", "field": "post", "value": post})
    assert 'post: {on_success: {count: "${count + 1}"}}' in made
    later: dict[str, object] = {"later": {"x": 1}}
    refused = {"edit": "set_field", "path": "root/sequence/Give_2", "field": "post", "value": later}
    assert "later" in refusal(TREE, refused)
    machine = TEXT.replace("third: {state: test.Give,", "third: {state: test.Give, description: x,")
    cut = "take:\n  state: test.Give\n  post: {always: {x: 1}}\n"
    pasted = edited(machine, {"edit": "paste", "parent": "root", "yaml": cut})
    assert "post" not in pasted
