"""The static check: each kind of finding has a bad example that gives it and a good one that does not."""

from __future__ import annotations

import itertools
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from engine.check import CODES, Finding, check_behavior, check_file
from engine.document import load_behavior, parse_behavior
from engine.errors import Position
from tests.engine.check.example_states import CATALOGUE, Maze

HEADER = "flexcell: 1\nname: example\noutcomes: [done, failed]\nsuccess: [done]\n"

MACHINE = (
    HEADER
    + """root:
  machine:
    initial: go
    states:
      go: {state: arm.Move, with: {robot: left}, transitions: {reached: done, failed: failed}}
"""
)

PARALLEL = (
    HEADER
    + """root:
  concurrency:
    states:
      left: {state: arm.Move, with: {robot: left}}
      right: {state: arm.Move, with: {robot: right}}
    conditions:
      - {done: {left: reached, right: reached}}
      - {failed: {left: failed}}
      - {failed: {right: failed}}
"""
)

KEYS = (
    HEADER
    + """parameters: {limit: {type: number, default: 0.5}}
root:
  machine:
    initial: look
    states:
      look: {state: camera.Look, transitions: {seen: pick, empty: failed}}
      pick: {state: arm.Pick, in: {part: part}, transitions: {held: go}}
      go: {state: arm.Move, with: {robot: left, speed: "${limit * 0.5}"}, transitions: {reached: done, failed: failed}}
"""
)

NESTED = (
    HEADER
    + """root:
  machine:
    initial: outer
    states:
      outer:
        machine:
          initial: go
          states:
            go: {state: arm.Move, with: {robot: left}, transitions: {reached: end, failed: bad}}
        transitions: {end: done, bad: failed}
"""
)

PREEMPTING = PARALLEL.replace(
    "      - {failed: {right: failed}}\n",
    "      - {preempt: [left], when: {right: failed}}\n"
    "      - {failed: {left: reached, right: failed}}\n"
    "    otherwise: failed\n",
)

REFERENCE = (
    HEADER
    + """root:
  machine:
    initial: sub
    states:
      sub: {behavior: part.yaml, with: {share: 0.5}, out: {count: total}, transitions: {done: done, failed: failed}}
"""
)

REFERRED = (
    HEADER
    + """parameters: {share: {type: number, minimum: 0, maximum: 1}}
userdata: {count: 0}
root:
  machine:
    initial: go
    states:
      go: {state: arm.Move, with: {robot: left, speed: "${share}"}, transitions: {reached: done, failed: failed}}
"""
)


@dataclass(frozen=True, kw_only=True)
class Case:
    """A good document and the edit that brings one kind of finding."""

    good: str
    old: str
    new: str
    path: str
    at: str
    """How the text goes on where the finding points."""
    says: str
    files: Mapping[str, str] = field(default_factory=dict[str, str])
    also: tuple[str, ...] = ()
    """Further codes that the same mistake brings with it."""
    already: tuple[str, ...] = ()
    """Codes that the good document has for reasons of its own."""


CASES: dict[str, list[Case]] = {
    "unknown-state": [
        Case(
            good=MACHINE,
            old="arm.Move",
            new="arm.Mvoe",
            path="root/go",
            at="arm.Mvoe, with",
            says="did you mean arm.Move",
        ),
    ],
    "module-not-allowed": [
        Case(
            good=MACHINE,
            old="arm.Move",
            new="no.such:State",
            path="root/go",
            at="no.such:State,",
            says="states: [no.such]",
        ),
    ],
    "unknown-parameter": [
        Case(
            good=MACHINE,
            old="robot: left}",
            new="robot: left, sped: 1}",
            path="root/go",
            at="sped: 1}, tran",
            says="did you mean speed?",
        ),
        Case(
            good=REFERENCE,
            files={"part.yaml": REFERRED},
            old="share: 0.5",
            new="share: 0.5, shar: 1",
            path="root/sub",
            at="shar: 1}, out:",
            says="did you mean share?",
            already=("required-parameter",),
        ),
    ],
    "missing-parameter": [
        Case(
            good=MACHINE,
            old="robot: left",
            new="",
            path="root/go",
            at="go: {state: ar",
            says="requires the parameter `robot`",
        ),
        Case(
            good=REFERENCE,
            files={"part.yaml": REFERRED},
            old="share: 0.5",
            new="",
            path="root/sub",
            at="sub: {behavior",
            says="requires the parameter `share`",
            already=("required-parameter",),
        ),
    ],
    "bad-parameter": [
        Case(
            good=MACHINE,
            old="robot: left",
            new="robot: left, speed: 2.0",
            path="root/go",
            at="2.0}, transiti",
            says="<= 1.0",
        ),
        Case(good=MACHINE, old="robot: left", new="robot: [1]", path="root/go", at="[1]}, transiti", says="`robot`"),
        Case(
            good=MACHINE,
            old="robot: left",
            new="robot: left, pose: {xyz: [0, 0, a]}",
            path="root/go",
            at="a]}}, transiti",
            says="expected number",
        ),
        Case(
            good=REFERENCE,
            files={"part.yaml": REFERRED},
            old="share: 0.5",
            new="share: 5",
            path="root/sub",
            at="5}, out: {coun",
            says="above the maximum 1",
            already=("required-parameter",),
        ),
    ],
    "unknown-input": [
        Case(
            good=KEYS,
            old="in: {part: part}",
            new="in: {part: part, prt: part}",
            path="root/pick",
            at="prt: part}, tr",
            says="did you mean part?",
        ),
    ],
    "unknown-output": [
        Case(
            good=KEYS,
            old="camera.Look",
            new="camera.Look, out: {prt: part}",
            path="root/look",
            at="prt: part}, tr",
            says="did you mean part?",
        ),
        Case(
            good=REFERENCE,
            files={"part.yaml": REFERRED},
            old="{count: total}",
            new="{cuont: total}",
            path="root/sub",
            at="cuont: total},",
            says="did you mean count?",
            already=("required-parameter",),
        ),
    ],
    "undefined-key": [
        Case(
            good=KEYS,
            old="in: {part: part}",
            new="in: {part: prat}",
            path="root/pick",
            at="prat}, transit",
            says="`prat`",
        ),
        Case(
            good=KEYS,
            old="camera.Look",
            new="camera.Look, out: {part: found}",
            path="root/pick",
            at="part}, transit",
            says="`part` is not defined",
        ),
    ],
    "bad-expression": [
        Case(
            good=KEYS, old="${limit * 0.5}", new="${limit *}", path="root/go", at='"${limit *}"},', says="Syntax error"
        ),
    ],
    "undeclared-name": [
        Case(
            good=KEYS,
            old="${limit * 0.5}",
            new="${limt * 0.5}",
            path="root/go",
            at='"${limt * 0.5}',
            says="did you mean limit?",
        ),
    ],
    "missing-entry": [
        Case(
            good=MACHINE,
            old="robot: left",
            new="robot: left, target: {entry: hom}",
            path="root/go",
            at="hom}}, transit",
            says="did you mean home?",
        ),
    ],
    "bad-declaration": [
        Case(good=KEYS, old="default: 0.5", new="default: fast", path="root", at="fast}}", says="not a number"),
        Case(
            good=KEYS,
            old="default: 0.5",
            new="default: 5, maximum: 1",
            path="root",
            at="5, maximum: 1}",
            says="maximum 1",
        ),
        Case(
            good=KEYS,
            old="default: 0.5",
            new="default: 1, minimum: 2, maximum: 1",
            path="root",
            at="2, maximum: 1}",
            says="above the maximum",
            also=("bad-declaration",),
        ),
        Case(
            good=KEYS,
            old="default: 0.5",
            new="default: 0.5, choices: [0.5, fast]",
            path="root",
            at="fast]}}",
            says="choice of parameter",
        ),
        Case(
            good=KEYS,
            old="number, default: 0.5",
            new="string, default: a, minimum: 1",
            path="root",
            at="1}}",
            says="has limits",
            also=("type-mismatch",),
        ),
    ],
    "required-parameter": [
        Case(good=KEYS, old=", default: 0.5", new="", path="root", at="limit: {type: ", says="for each run"),
    ],
    "unknown-success": [
        Case(
            good=MACHINE,
            old="success: [done]",
            new="success: [dnoe]",
            path="root",
            at="dnoe]",
            says="did you mean done?",
        ),
    ],
    "unknown-outcome": [
        Case(
            good=MACHINE,
            old="failed: failed}",
            new="failed: failed, lost: failed}",
            path="root/go",
            at="lost: failed}}",
            says="no outcome `lost`",
        ),
        Case(
            good=MACHINE,
            old="state: arm.Move",
            new="retry: {times: 2, outcomes: [lost]}, state: arm.Move",
            path="root/go",
            at="lost]}, state:",
            says="no outcome `lost`",
        ),
        Case(
            good=PARALLEL,
            old="left: failed}",
            new="left: faild}",
            path="root",
            at="faild}}",
            says="did you mean failed?",
        ),
    ],
    "unknown-target": [
        Case(
            good=MACHINE,
            old="reached: done",
            new="reached: doen",
            path="root/go",
            at="doen, failed: ",
            says="did you mean done?",
            also=("unused-outcome",),
        ),
        Case(
            good=MACHINE,
            old="state: arm.Move",
            new="timeout: {after: 2 s, to: nowhere}, state: arm.Move",
            path="root/go",
            at="nowhere}, stat",
            says="`nowhere`",
        ),
        Case(
            good=MACHINE,
            old="state: arm.Move",
            new="on_error: nowhere, state: arm.Move",
            path="root/go",
            at="nowhere, state",
            says="`nowhere`",
        ),
        Case(
            good=NESTED,
            old="reached: end",
            new="reached: edn",
            path="root/outer/go",
            at="edn, failed: b",
            says="did you mean end",
            also=("unused-outcome",),
        ),
        Case(
            good=PARALLEL,
            old="root:\n",
            new="root:\n  on_error: nowhere\n",
            path="root",
            at="nowhere",
            says="not an outcome of this behavior",
        ),
    ],
    "unconnected-outcome": [
        Case(
            good=MACHINE,
            old=", failed: failed}",
            new="}",
            path="root/go",
            at="go: {state: ar",
            says="outcome `failed` of `go`",
            also=("unused-outcome",),
        ),
        Case(
            good=PARALLEL,
            old="outcomes: [done, failed]",
            new="outcomes: [done]",
            path="root",
            at="root:",
            says="outcome `failed` of the root",
        ),
    ],
    "ambiguous-target": [
        Case(
            good=MACHINE,
            old="outcomes: [done, failed]",
            new="outcomes: [done, failed, go]",
            path="root/go",
            at="go: {state: ar",
            says="rename the state",
            also=("unused-outcome",),
        ),
    ],
    "missing-initial": [
        Case(good=MACHINE, old="initial: go", new="initial: og", path="root", at="og", says="known: go"),
    ],
    "unreachable-node": [
        Case(
            good=MACHINE,
            old="    states:\n",
            new="    states:\n      idle: {state: arm.Pick, in: {part: p}, transitions: {held: done}}\n",
            path="root/idle",
            at="idle: {state: ",
            says="no transition leads to `idle`",
        ),
    ],
    "no-path-to-outcome": [
        Case(
            good=MACHINE,
            old="reached: done, failed: failed",
            new="reached: go, failed: go",
            path="root/go",
            at="go: {state: ar",
            says="from `go`",
            also=("unused-outcome", "unused-outcome"),
        ),
    ],
    "unused-outcome": [
        Case(
            good=MACHINE,
            old="outcomes: [done, failed]",
            new="outcomes: [done, failed, lost]",
            path="root",
            at="lost]",
            says="`lost`",
        ),
        Case(
            good=NESTED,
            old="bad: failed}\n",
            new="bad: failed, odd: failed}\n",
            path="root/outer",
            at="odd: failed}",
            says="no outcome `odd`",
        ),
    ],
    "unknown-child": [
        Case(
            good=PARALLEL,
            old="{left: failed}",
            new="{lfet: failed}",
            path="root",
            at="lfet: failed}}",
            says="did you mean left",
        ),
        Case(
            good=PREEMPTING,
            old="preempt: [left]",
            new="preempt: [lfet]",
            path="root",
            at="lfet], when",
            says="did you mean left",
        ),
        Case(
            good=PREEMPTING,
            old="when: {right",
            new="when: {rihgt",
            path="root",
            at="rihgt: failed}",
            says="did you mean right",
        ),
    ],
    "preempts-itself": [
        Case(
            good=PREEMPTING,
            old="preempt: [left]",
            new="preempt: [left, right]",
            path="root",
            at="right], when",
            says="this condition preempts `right`, which has already ended when it holds",
        ),
    ],
    "uncovered-combination": [
        Case(
            good=PREEMPTING,
            old="    otherwise: failed\n",
            new="",
            path="root",
            at="conditions:",
            says="left: preempted, right: failed",
        ),
        Case(
            good=PARALLEL,
            old="      - {failed: {right: failed}}\n",
            new="",
            path="root",
            at="conditions:",
            says="left: reached, right: failed",
        ),
        Case(
            good=PARALLEL.replace(
                "{done: {left: reached, right: reached}}", "{done: {left: reached, right: reached, at_least: 1}}"
            ).replace("      - {failed: {right: failed}}\n", ""),
            old="at_least: 1",
            new="at_least: 2",
            path="root",
            at="conditions:",
            says="left: reached, right: failed",
        ),
        Case(
            good=PARALLEL,
            old="right: {state",
            new="right: {timeout: {after: 1 s, to: late}, state",
            path="root",
            at="conditions:",
            says="right: late",
        ),
    ],
    "shared-resource": [
        Case(
            good=PARALLEL,
            old="robot: right",
            new="robot: left",
            path="root/right",
            at="right: {state:",
            says="both command `left`",
        ),
    ],
}


def cases() -> list[object]:
    """Name each case by its code."""
    return [pytest.param(code, case, id=f"{code}-{i}") for code, some in CASES.items() for i, case in enumerate(some)]


def written(folder: Path, text: str, files: Mapping[str, str]) -> Path:
    """Write a behavior and the files around it and return its path."""
    for name, content in files.items():
        (folder / name).write_text(content, encoding="utf-8")
    file = folder / "behavior.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def text_at(file: Path, position: Position) -> str:
    """Return the rest of the line that a position points into."""
    return file.read_text(encoding="utf-8").splitlines()[position.line - 1][position.column - 1 :]


def codes(findings: tuple[Finding, ...]) -> list[str]:
    """Return the codes, sorted."""
    return sorted(finding.code for finding in findings)


@pytest.mark.parametrize(("code", "case"), cases())
def test_a_mistake_is_found_where_it_stands(tmp_path: Path, code: str, case: Case) -> None:
    """The bad example gives the finding with path, position and a hint, and nothing that is not expected."""
    assert case.old in case.good
    file = written(tmp_path, case.good.replace(case.old, case.new, 1), case.files)
    findings = check_file(file, CATALOGUE, entries={"joints": {"home"}})
    assert codes(findings) == sorted([code, *case.also, *case.already])
    expected = [f for f in findings if f.code == code and case.says in str(f)]
    assert [(f.path, f.severity, f.position.file) for f in expected] == [(case.path, CODES[code][0], str(file))]
    assert text_at(file, expected[0].position).startswith(case.at)


@pytest.mark.parametrize(("code", "case"), cases())
def test_the_good_example_does_not_give_the_finding(tmp_path: Path, code: str, case: Case) -> None:
    """Without the mistake there is nothing to find but what the example declares."""
    findings = check_file(written(tmp_path, case.good, case.files), CATALOGUE, entries={"joints": {"home"}})
    assert codes(findings) == sorted(case.already)


def test_an_unreadable_file_is_one_finding(tmp_path: Path) -> None:
    """Check reports what loading would raise."""
    file = written(tmp_path, MACHINE.replace("machine", "machin"), {})
    (finding,) = check_file(file, CATALOGUE)
    assert (finding.code, finding.position.line, finding.hint) == ("invalid-document", 6, "did you mean machine?")


def test_a_circle_of_behaviors_names_the_chain(tmp_path: Path) -> None:
    """The finding stands at the reference that closes the circle."""
    other = REFERRED.replace("state: arm.Move", "behavior: behavior.yaml").replace("{robot: left, speed: ", "{share: ")
    file = written(tmp_path, REFERENCE.replace(", out: {count: total}", ""), {"part.yaml": other})
    found = [f for f in check_file(file, CATALOGUE) if f.code == "circular-behavior"]
    assert [(f.message, Path(f.position.file).name, f.position.line) for f in found] == [
        ("circular behavior reference: behavior.yaml → part.yaml → behavior.yaml", "part.yaml", 11)
    ]


def test_findings_inside_a_referenced_behavior_carry_its_file_and_the_path_in_the_run(tmp_path: Path) -> None:
    """A referenced behavior is checked once, under the reference that uses it first."""
    bad = REFERRED.replace("arm.Move", "arm.Mvoe")
    again = "      again: {behavior: part.yaml, with: {share: 1}, transitions: {done: done, failed: failed}}\n"
    twice = REFERENCE.replace("{done: done, failed: failed}}\n", "{done: again, failed: failed}}\n") + again
    findings = check_file(written(tmp_path, twice, {"part.yaml": bad}), CATALOGUE)
    found = [(f.path, Path(f.position.file).name) for f in findings if f.code == "unknown-state"]
    assert found == [("root/sub/root/go", "part.yaml")]


def test_a_resource_inside_a_referenced_behavior_counts(tmp_path: Path) -> None:
    """Parallel branches are compared through references, with the parameters they give."""
    part = REFERRED.replace("share: {type: number, minimum: 0, maximum: 1}", "arm: {type: string, default: x}")
    part = part.replace('{robot: left, speed: "${share}"}', '{robot: "${arm}"}')
    text = PARALLEL.replace("{state: arm.Move, with: {robot: left}}", "{behavior: part.yaml, with: {arm: right}}")
    text = text.replace("left: reached", "left: done")
    findings = check_file(written(tmp_path, text, {"part.yaml": part}), CATALOGUE)
    assert [f.message for f in findings] == ["`left` and `right` run concurrently and both command `right`"]


def test_resources_that_only_a_run_knows_are_not_compared() -> None:
    """Two branches whose robots are parameters may be different robots."""
    text = PARALLEL.replace("robot: left", 'robot: "${arm}"').replace("robot: right", 'robot: "${arm}"')
    text = text.replace("root:", "parameters: {arm: {type: string, default: left}}\nroot:")
    assert check_behavior(parse_behavior(text, file="x.yaml"), CATALOGUE) == ()


def test_otherwise_covers_every_combination() -> None:
    """With `otherwise` no combination is left open, and it is an outcome of the container."""
    text = PARALLEL.replace(
        "      - {failed: {left: failed}}\n      - {failed: {right: failed}}\n", "    otherwise: failed\n"
    )
    assert check_behavior(parse_behavior(text, file="x.yaml"), CATALOGUE) == ()


def test_a_child_that_never_ends_leaves_nothing_uncovered() -> None:
    """All children are never finished together; that the child never ends is reported instead."""
    go = "{state: arm.Move, with: {robot: x}, transitions: {reached: go, failed: go}}"
    endless = f"machine: {{initial: go, states: {{go: {go}}}}}"
    text = PARALLEL.replace("{state: arm.Move, with: {robot: left}}", f"{{{endless}}}")
    text = text.replace("left: reached, ", "").replace("      - {failed: {left: failed}}\n", "")
    found = check_behavior(parse_behavior(text, file="x.yaml"), CATALOGUE)
    assert [finding.code for finding in found] == ["no-path-to-outcome"]


def test_many_children_are_covered_without_counting_all_combinations() -> None:
    """Forty children with two outcomes each have 10^12 combinations; the conditions decide them quickly."""
    names = [f"c{i}" for i in range(40)]
    children = "".join(f"      {name}: {{state: arm.Move, with: {{robot: {name}}}}}\n" for name in names)
    failing = "".join(f"      - {{failed: {{{name}: failed}}}}\n" for name in names)
    reached = f"      - {{done: {{{', '.join(f'{name}: reached' for name in names)}}}}}\n"
    text = f"{HEADER}root:\n  concurrency:\n    states:\n{children}    conditions:\n{reached}{failing}"
    start = time.process_time()
    assert check_behavior(parse_behavior(text, file="x.yaml"), CATALOGUE) == ()
    open_text = text.replace(failing.splitlines(keepends=True)[7], "")
    found = check_behavior(parse_behavior(open_text, file="x.yaml"), CATALOGUE)
    assert [f.code for f in found] == ["uncovered-combination"]
    assert "c7: failed" in found[0].message
    assert time.process_time() - start < 2.0


def test_counts_are_covered_without_counting_all_combinations() -> None:
    """Any thirty of forty, or eleven that are not among them: all but no combination; twelve leave one open."""
    names = [f"c{i}" for i in range(40)]
    children = "".join(f"      {name}: {{state: arm.Move, with: {{robot: {name}}}}}\n" for name in names)
    rules = "".join(
        f"      - {{{end}: {{{', '.join(f'{name}: {due}' for name in names)}, at_least: {count}}}}}\n"
        for end, due, count in (("done", "reached", 30), ("failed", "failed", 11))
    )
    text = f"{HEADER}root:\n  concurrency:\n    states:\n{children}    conditions:\n{rules}"
    assert check_behavior(parse_behavior(text, file="x.yaml"), CATALOGUE) == ()
    found = check_behavior(parse_behavior(text.replace("at_least: 11", "at_least: 12"), file="x.yaml"), CATALOGUE)
    assert {finding.code for finding in found} <= {"uncovered-combination", "combinations-not-checked"}
    assert found[0].message.count("failed") == 11


def test_a_search_that_would_take_too_long_is_said_to_be_incomplete() -> None:
    """Nine pigeons in eight holes always share one, which no short search can tell: a warning, not a silence."""
    pigeons, holes = [f"p{i}" for i in range(9)], Maze.outcomes
    children = "".join(f"      {name}: {{state: maze.Leave}}\n" for name in pigeons)
    rules = "".join(
        f"      - {{done: {{{a}: {hole}, {b}: {hole}}}}}\n"
        for a, b in itertools.combinations(pigeons, 2)
        for hole in holes
    )
    text = f"{HEADER}root:\n  concurrency:\n    states:\n{children}    conditions:\n{rules}"
    start = time.process_time()
    found = [f.code for f in check_behavior(parse_behavior(text, file="x.yaml"), CATALOGUE)]
    assert found == ["unused-outcome", "combinations-not-checked"]
    assert time.process_time() - start < 2.0


def test_ten_thousand_states_are_checked_within_seconds() -> None:
    """The check grows with the size of the document, not faster."""
    states = "".join(
        f"      s{i}: {{state: arm.Move, with: {{robot: left}}, transitions: {{reached: s{i + 1}, failed: failed}}}}\n"
        for i in range(10_000)
    )
    last = "      s10000: {state: arm.Move, with: {robot: left}, transitions: {reached: done, failed: failed}}\n"
    text = f"{HEADER}root:\n  machine:\n    initial: s0\n    states:\n{states}{last}"
    behavior = parse_behavior(text, file="x.yaml")
    start = time.process_time()
    assert check_behavior(behavior, CATALOGUE) == ()
    assert time.process_time() - start < 3.0


def test_a_loaded_behavior_and_its_file_give_the_same_findings(tmp_path: Path) -> None:
    """The editor checks what it has loaded, the command line checks files."""
    file = written(tmp_path, MACHINE.replace("reached: done", "reached: doen"), {})
    assert check_file(file, CATALOGUE) == check_behavior(load_behavior(file), CATALOGUE)
