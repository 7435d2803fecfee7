"""Quick fixes: each offered fix can be made, says all that it does, and takes its finding away."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest

from engine.editing import analyze_text, apply_edits
from engine.editing.fixes import Fix, fixes_of
from engine.library.behavior_library import FindingView
from tests.engine.editing.edit_fixtures import context, difference

FILE = Path("no-such-project/x.yaml")
HEAD = "flexcell: 1\nname: x\noutcomes: [good, failed]\nsuccess: [good]\n"
MACHINE = HEAD + "root:\n  machine:\n    initial: first\n    states:\n"


def findings_of(text: str) -> tuple[FindingView, ...]:
    """What the check says."""
    return analyze_text(text, file=FILE, context=context(FILE.parent)).findings


def offered(text: str, code: str) -> list[tuple[FindingView, Fix]]:
    """The fixes of all findings of a kind; there must be such a finding."""
    findings = findings_of(text)
    assert code in [each.code for each in findings], findings
    fixes = fixes_of(text, findings, file=str(FILE), context=context(FILE.parent))
    return [(found, fix) for found, each in zip(findings, fixes, strict=True) if found.code == code for fix in each]


def mended(text: str, fix: Fix) -> str:
    """The text after a fix, which must not be refused."""
    done = apply_edits(text, fix.edits, file="x.yaml", context=context(FILE.parent))
    assert done.refused is None, (fix, done.refused)
    return done.text


def states(*lines: str) -> str:
    """A machine of these states, one a line."""
    return MACHINE + "".join(f"      {line}\n" for line in lines)


LOOSE = states(
    "first: {state: test.Give, transitions: {a: second, b: failed}}",
    "second: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}",
)
SLIPS = [
    ("unconnected-outcome", LOOSE, "Connect `c` to `failed`"),
    (
        "unconnected-outcome",
        "flexcell: 1\nname: x\noutcomes: [good]\nsuccess: [good]\nroot: {state: flow.Wait, with: {duration_s: 1}}\n",
        "Add `done` to the outcomes of the behavior",
    ),
    (
        "unknown-outcome",
        states("first: {state: flow.Wait, with: {duration_s: 1}, transitions: {dome: good}}"),
        "Connect `done` instead of `dome`",
    ),
    (
        "unknown-outcome",
        states("first: {state: flow.Wait, with: {duration_s: 1}, autonomy: {dome: low}, transitions: {done: good}}"),
        "Write `done` instead of `dome`",
    ),
    (
        "unknown-target",
        states(
            "first: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: secnd}}",
            "second: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}",
        ),
        "Connect to `second` instead of `secnd`",
    ),
    (
        "missing-initial",
        states("fist: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}"),
        "Begin with `fist`",
    ),
    (
        "unreachable-node",
        states(
            "first: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}",
            "second: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}",
        ),
        "Delete `second`",
    ),
    (
        "unknown-state",
        states("first: {state: flow.Wiat, with: {duration_s: 1}, transitions: {done: good}}"),
        "Run `flow.Wait`",
    ),
    (
        "unknown-parameter",
        states("first: {state: flow.Wait, with: {duration: 1}, transitions: {done: good}}"),
        "Rename it to `duration_s`",
    ),
    (
        "missing-parameter",
        states("first: {state: flow.Wait, transitions: {done: good}}"),
        "Make `duration_s` a parameter of the behavior",
    ),
    (
        "bad-parameter",
        states("first: {state: flow.Wait, with: {duration_s: -3}, transitions: {done: good}}"),
        "Set `duration_s` to its limit 0",
    ),
    (
        "unused-parameter",
        HEAD + "parameters: {speed: {type: number, default: 1}}\n" + states(
            "first: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}"
        ).removeprefix(HEAD),
        "Remove the parameter `speed`",
    ),
    (
        "unknown-success",
        LOOSE.replace("success: [good]", "success: [goood]"),
        "Write `good` instead of `goood`",
    ),
    (
        "unused-outcome",
        states("first: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}"),
        "Remove the outcome `failed`",
    ),
    (
        "constant-guard",
        states(
            "first: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good},",
            '        guard: {when: "${true}", to: failed}}',
        ),
        "Remove the guard",
    ),
    (
        "autonomy-never-passes",
        states("first: {state: flow.Wait, with: {duration_s: 1}, autonomy: {done: full}, transitions: {done: good}}"),
        "Require `high` for `done`",
    ),
    (
        "bad-resume",
        states("first: {state: flow.Wait, with: {duration_s: 1}, resume: rerum, transitions: {done: good}}"),
        "Resume with `rerun`",
    ),
    (
        "unknown-child",
        HEAD + dedent("""\
        root:
          concurrency:
            states:
              left: {state: flow.Wait, with: {duration_s: 1}}
            conditions: [{good: {leftt: done}}]
            otherwise: failed
        """),
        "Write `left` instead of `leftt`",
    ),
    (
        "unknown-child",
        HEAD + dedent("""\
        root:
          concurrency:
            states:
              left: {state: flow.Wait, with: {duration_s: 1}}
              right: {state: flow.Wait, with: {duration_s: 1}}
            conditions: [{preempt: [rihgt], when: {left: done}}, {good: {right: done}}]
            otherwise: failed
        """),
        "Write `right` instead of `rihgt`",
    ),
    (
        "preempts-itself",
        HEAD + dedent("""\
        root:
          concurrency:
            states:
              left: {state: flow.Wait, with: {duration_s: 1}}
              right: {state: flow.Wait, with: {duration_s: 1}}
            conditions: [{preempt: [left, right], when: {left: done}}, {good: {right: done}}]
            otherwise: failed
        """),
        "Do not preempt `left`",
    ),
    (
        "uncovered-combination",
        HEAD + dedent("""\
        root:
          concurrency:
            states:
              left: {state: flow.Wait, with: {duration_s: 1}}
              right: {state: flow.Wait, with: {duration_s: 1}}
            conditions: [{preempt: [right], when: {left: done}}, {good: {right: done}}]
        """),
        "Otherwise end with `good`",
    ),
    (
        "uncovered-combination",
        HEAD + dedent("""\
        root:
          concurrency:
            states:
              left: {state: test.Give}
            conditions: [{good: {left: a}}, {failed: {left: b}}]
        """),
        "Otherwise end with `failed`",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("code", "text", "title"), SLIPS, ids=[f"{code}: {title}" for code, _, title in SLIPS])
def test_a_fix_is_offered_can_be_made_and_takes_its_finding_away(code: str, text: str, title: str) -> None:
    found = offered(text, code)
    assert title in [fix.title for _, fix in found]
    for finding, fix in found:
        left = [(each.code, each.path, each.message) for each in findings_of(mended(text, fix))]
        assert (finding.code, finding.path, finding.message) not in left, fix


def test_a_fix_changes_the_lines_that_it_is_about_and_no_others() -> None:
    fix = next(fix for _, fix in offered(LOOSE, "unconnected-outcome") if fix.title == "Connect `c` to `failed`")
    assert difference(LOOSE, mended(LOOSE, fix)) == [
        "-      first: {state: test.Give, transitions: {a: second, b: failed}}",
        "+      first: {state: test.Give, transitions: {a: second, b: failed, c: failed}}",
    ]


def test_the_likeliest_target_of_an_outcome_comes_first() -> None:
    """A good outcome goes on to the next state, one of the same name out by it."""
    text = states(
        "first: {state: flow.Wait, with: {duration_s: 1}}",
        "second: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}",
    )
    titles = [fix.title for _, fix in offered(text, "unconnected-outcome")]
    assert titles == ["Connect `done` to `second`", "Connect `done` to `good`", "Connect `done` to `failed`"]


def test_a_missing_parameter_takes_the_one_of_the_behavior_of_the_same_name() -> None:
    text = "parameters: {duration_s: {type: number, default: 1}}\n" + states(
        "first: {state: flow.Wait, transitions: {done: good}}"
    )
    fix = offered(text, "missing-parameter")[0][1]
    assert fix.title == "Insert `duration_s: ${duration_s}`"
    assert 'with: {duration_s: "${duration_s}"}' in mended(text, fix)


def test_what_only_a_person_can_correct_has_no_fix() -> None:
    text = states("first: {state: flow.Wait, with: {duration_s: soon}, transitions: {done: first}}")
    assert offered(text, "no-path-to-outcome") == []


def test_a_text_that_cannot_be_read_has_no_fix() -> None:
    assert fixes_of("{", findings_of("{"), file="x.yaml", context=context()) == ((),)


def test_what_is_wrong_in_another_behavior_is_mended_there(tmp_path: Path) -> None:
    (tmp_path / "inner.yaml").write_text(LOOSE)
    text = states("first: {behavior: inner.yaml, transitions: {good: good, failed: failed}}")
    known = context(tmp_path)
    findings = analyze_text(text, file=tmp_path / "x.yaml", context=known).findings
    assert [each.code for each in findings] == ["unconnected-outcome"]
    assert fixes_of(text, findings, file="x.yaml", context=known) == ((),)


def test_a_mistake_in_one_condition_leaves_those_that_preempt_as_they_are() -> None:
    """Fixes write the conditions as a whole, whom they preempt included; `otherwise` is offered their outcomes only."""
    text = HEAD + dedent("""\
        root:
          concurrency:
            states:
              left: {state: flow.Wait, with: {duration_s: 1}}
              right: {state: flow.Wait, with: {duration_s: 1}}
            conditions: [{preempt: [right], when: {left: done}}, {good: {rihgt: done}}]
        """)
    made = mended(text, next(fix for _, fix in offered(text, "unknown-child")))
    assert "conditions: [{preempt: [right], when: {left: done}}, {good: {right: done}}]" in made
    assert [fix.title for _, fix in offered(made, "uncovered-combination")] == ["Otherwise end with `good`"]
