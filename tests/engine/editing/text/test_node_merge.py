"""Changes of two people to one document are merged by nodes and fields; what both changed is for a person."""

from __future__ import annotations

from engine.editing.text.node_merge import NodeMerge, Side, merge_by_nodes
from tests.engine.editing.edit_fixtures import difference

BASE = """\
flexcell: 1
name: shift
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: first
    states:
      first: {state: test.Give, transitions: {a: second, b: second, c: bad}}   # begins
      second:
        # It cools.
        state: flow.Wait
        with: {duration_s: 1, kind: slow}
        transitions: {done: third}
      third:
        tree:
          sequence:
            - {state: flow.Wait, name: one, with: {duration_s: 1}}
            - {state: flow.Wait, name: two, with: {duration_s: 1}}
        transitions: {success: good, failure: bad}
view: {root/first: [0, 0]}
"""


def merged(mine: str, theirs: str, **sides: Side) -> NodeMerge:
    made = merge_by_nodes(BASE, mine, theirs, file="x.yaml", sides=sides)
    assert made is not None
    return made


def conflicts(made: NodeMerge) -> list[tuple[str, str, object, object]]:
    return [(each.path, each.field, each.mine, each.theirs) for each in made.conflicts]


def test_fields_of_one_node_on_one_line_are_merged_with_their_comments() -> None:
    mine = BASE.replace("duration_s: 1, kind", "duration_s: 2, kind").replace("# begins", "# begins here")
    theirs = BASE.replace("kind: slow", "kind: fast")
    made = merged(mine, theirs)
    assert made.conflicts == ()
    assert made.theirs_changed == ("root/second",)
    assert difference(BASE, made.text) == [
        "-        with: {duration_s: 1, kind: slow}",
        "+        with: {duration_s: 2, kind: fast}",
    ]


def test_changes_of_other_lines_keep_the_comments_of_both() -> None:
    mine = BASE.replace("# begins", "# begins here").replace("initial: first", "initial: second")
    theirs = BASE.replace("# It cools.", "# It cools slowly.").replace("kind: slow", "kind: fast")
    made = merged(mine, theirs)
    assert made.conflicts == ()
    assert "# begins here" in made.text
    assert "# It cools slowly." in made.text


def test_what_both_changed_is_a_conflict_of_that_field_alone() -> None:
    mine = BASE.replace("duration_s: 1, kind: slow", "duration_s: 2, kind: calm")
    theirs = BASE.replace("duration_s: 1, kind: slow", "duration_s: 3, kind: slow")
    made = merged(mine, theirs)
    assert conflicts(made) == [("root/second", "with.duration_s", 2, 3)]
    assert "{duration_s: 2, kind: calm}" in made.text
    chosen = merge_by_nodes(BASE, mine, theirs, file="x.yaml", sides={made.conflicts[0].key: "theirs"})
    assert chosen is not None
    assert "{duration_s: 3, kind: calm}" in chosen.text
    assert [each.side for each in chosen.conflicts] == ["theirs"]


def test_nodes_of_both_are_added_and_a_removed_one_that_changed_is_a_conflict() -> None:
    new = "      {name}: {{state: flow.Wait, with: {{duration_s: 5}}, transitions: {{done: good}}}}\n"
    mine = BASE.replace("view:", new.format(name="mine") + "view:").replace("[good, bad]", "[good, bad, late]")
    theirs = BASE.replace("view:", new.format(name="theirs") + "view:").replace("[good, bad]", "[good, bad, early]")
    made = merged(mine, theirs)
    assert made.conflicts == ()
    assert "outcomes: [good, bad, early, late]" in made.text
    assert ("      mine: {" in made.text, "      theirs: {" in made.text) == (True, True)
    start, end = BASE.index("      second:\n"), BASE.index("      third:\n")
    without = BASE[:start] + BASE[end:]
    gone = merged(without, BASE.replace("kind: slow", "kind: fast"))
    assert [(each.path, each.field, each.mine) for each in gone.conflicts] == [("root/second", "", None)]
    assert "second:" not in gone.text
    kept = merge_by_nodes(
        BASE, without, BASE.replace("kind: slow", "kind: fast"), file="x.yaml", sides={"root/second ": "theirs"}
    )
    assert kept is not None
    assert "kind: fast" in kept.text


def test_a_node_that_runs_something_else_is_not_mixed_with_new_parameters() -> None:
    mine = BASE.replace("state: flow.Wait\n        with: {duration_s: 1, kind: slow}", "state: test.Give")
    theirs = BASE.replace("duration_s: 1, kind", "duration_s: 3, kind")
    assert [(each.path, each.field) for each in merged(mine, theirs).conflicts] == [("root/second", "")]


def test_a_renamed_node_takes_the_change_of_the_other_side_along() -> None:
    def renamed(text: str) -> str:
        return text.replace("second", "wait")

    changed = BASE.replace("kind: slow", "kind: fast")
    for mine, theirs in ((renamed(BASE), changed), (changed, renamed(BASE))):
        made = merged(mine, theirs)
        assert (made.conflicts, made.text) == ((), renamed(changed))


def test_children_of_a_tree_are_merged_by_name_and_positions_never_conflict() -> None:
    mine = BASE.replace("name: one, with: {duration_s: 1}", "name: one, with: {duration_s: 2}").replace(
        "[0, 0]", "[1, 1]"
    )
    theirs = BASE.replace("name: two, with: {duration_s: 1}", "name: two, with: {duration_s: 3}").replace(
        "[0, 0]", "[2, 2]"
    )
    made = merged(mine, theirs)
    assert made.conflicts == ()
    assert "root/first: [1, 1]" in made.text
    assert "name: two, with: {duration_s: 3}" in made.text
    both = merged(mine, BASE.replace("name: one, with: {duration_s: 1}", "name: one, with: {duration_s: 4}"))
    assert conflicts(both) == [("root/third/sequence/one", "with.duration_s", 2, 4)]


def test_a_text_that_cannot_be_read_is_not_merged() -> None:
    assert merge_by_nodes(BASE, "flexcell: [", BASE, file="x.yaml", sides={}) is None
