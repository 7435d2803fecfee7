"""`if_then_else` chooses once, `while_do_else` for as long as it runs."""

from __future__ import annotations

import pytest

from engine.errors import DocumentError
from tests.engine.runtime.tree.run_tree import run_tree, tree_plan

VALUE = "userdata: {value: 0}"
WRITING = """
    while_do_else:
      while: {guard: {when: "${value < 5}", child: {state: test.Check}}}
      do:
        sequence:
          - machine:
              initial: write
              states:
                write: {state: test.Write, with: {value: 9, after_s: 1}, out: {value: value}, transitions: {done: wait}}
                wait: {state: test.Act, with: {script: [[9, true]], cleanup_s: 1}, transitions: {yes: done, no: done}}
      else: {state: test.Act, name: b, with: {script: [[2, true]]}}
"""


def test_what_runs_is_halted_and_cleaned_up_before_the_other_begins() -> None:
    """The condition changes after 1 s, in the middle of `do`; its clean-up takes another."""
    told = run_tree(WRITING, head=VALUE)
    assert told.entered("b") == [2.0]
    assert "2 !while_do_else/sequence/machine/wait clean" in told.lines
    assert (told.result.outcome, told.result.duration_s) == ("success", 4.0)


@pytest.mark.parametrize(
    ("answer", "then", "otherwise", "outcome", "entered"),
    [
        ("true", "true", "false", "success", "then"),
        ("true", "false", "true", "failure", "then"),
        ("false", "false", "true", "success", "other"),
        ("false", "true", "false", "failure", "other"),
    ],
)
@pytest.mark.parametrize("kind", ["if_then_else", "while_do_else"])
def test_it_ends_as_the_branch_that_is_chosen(
    kind: str, answer: str, then: str, otherwise: str, outcome: str, entered: str
) -> None:
    """A first branch that fails is no reason to run the other: this is what a selector cannot say."""
    first, second = ("if", "then") if kind == "if_then_else" else ("while", "do")
    told = run_tree(f"""
    {kind}:
      {first}: {{state: test.Check, with: {{script: [[0, {answer}]]}}}}
      {second}: {{state: test.Act, name: then, with: {{script: [[1, {then}]]}}}}
      else: {{state: test.Act, name: other, with: {{script: [[1, {otherwise}]]}}}}
    """)
    assert told.result.outcome == outcome
    assert [name for name in ("then", "other") if told.entered(name)] == [entered]


@pytest.mark.parametrize(("kind", "keys"), [("if_then_else", ("if", "then")), ("while_do_else", ("while", "do"))])
def test_without_else_it_fails_with_its_condition(kind: str, keys: tuple[str, str]) -> None:
    """And the cause leads to that."""
    told = run_tree(
        f"{kind}: {{{keys[0]}: {{state: test.Check, with: {{script: [[0, false]]}}}}, {keys[1]}: {{state: test.Act}}}}"
    )
    assert told.result.outcome == "failure"
    assert told.why[-1] == "Check ended with no"


def test_a_choice_is_made_once() -> None:
    """What the condition of `if_then_else` reads may change while a branch runs."""
    told = run_tree(
        WRITING.replace("while_do_else", "if_then_else").replace("while:", "if:").replace("do:", "then:"), head=VALUE
    )
    assert (told.result.outcome, told.entered("b"), told.result.duration_s) == ("success", [], 10.0)


def test_in_a_loop_it_chooses_anew() -> None:
    """The second round takes the other branch."""
    told = run_tree("""
    repeat:
      times: 2
      child:
        if_then_else:
          if: {state: test.Check, with: {script: [[0, true], [0, false]]}}
          then: {state: test.Act, name: a, with: {script: [[1, true]]}}
          else: {state: test.Act, name: b, with: {script: [[1, true]]}}
    """)
    assert (told.entered("a"), told.entered("b")) == ([0.0], [1.0])


def test_children_may_have_one_name() -> None:
    """The second gets a number, as everywhere in trees."""
    plan = tree_plan("if_then_else: {if: {state: test.Check}, then: {state: test.Act}, else: {state: test.Act}}")
    assert {"root/if_then_else/Act", "root/if_then_else/Act_2"} <= set(plan.nodes)


@pytest.mark.parametrize(
    ("inside", "message"),
    [
        ("if: {state: test.Check}", "`then`"),
        ("then: {state: test.Act}", "`if`"),
        ("if: {state: test.Check}, then: {state: test.Act}, do: {state: test.Act}", "`do`"),
    ],
)
def test_a_role_that_is_missing_or_unknown_is_refused(inside: str, message: str) -> None:
    """At its place in the document."""
    with pytest.raises(DocumentError, match=message):
        tree_plan(f"if_then_else: {{{inside}}}")
