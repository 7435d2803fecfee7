"""Substitutes: nodes that end as a test says while the rest of the behavior is run as it is."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.document.cell import load_cell
from engine.document.substitutes import parse_substitutes
from engine.errors import ControlError, DocumentError, Position
from engine.event import Event, NodeEntered, NodeExited
from engine.project.run_request import require_simulation
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from engine.state import Context, Outcome, State
from engine.testing import SubstituteEnding, run_behavior
from tests.engine.fake_states import WITH_FLOW
from tests.engine.run_document import HEAD

CHAIN = f"""{HEAD}userdata: {{note: none}}
root:
  machine:
    initial: look
    states:
      look: {{state: test.Give, transitions: {{a: act, b: tell, c: look}}}}
      act:
        concurrency:
          states:
            left: {{state: flow.Wait, with: {{duration_s: 1000}}}}
            right: {{state: flow.SetValue, with: {{value: moved}}, out: {{value: note}}}}
          conditions: [{{done: {{left: done, right: done}}}}]
          otherwise: failed
        on_error: bad
        transitions: {{done: tell, failed: bad}}
      tell: {{state: flow.Log, with: {{message: "${{note}}"}}, transitions: {{done: good}}}}
"""


class Hurried(State, frozen=True, kw_only=True):
    """Stands in for a state that waits for long."""

    state_name: ClassVar[str] = "test.Hurried"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    duration_s: float = 0.0

    async def run(self, ctx: Context) -> Outcome:
        ctx.log("hurried")
        return Outcome("done")


def _plan(substitutes: str, text: str = CHAIN) -> Plan:
    made = parse_substitutes(f"flexcell: 1\nsubstitutes:\n{substitutes}", file="s.yaml")
    return new_plan(
        parse_behavior(text, file="test.yaml").with_substitutes(made), {**WITH_FLOW, "test.Hurried": Hurried}
    )


def _run(plan: Plan) -> tuple[RunResult, list[Event]]:
    events: list[Event] = []

    async def main() -> RunResult:
        async with SkillBus(new_clock()) as bus:
            run = Run(plan, run="test", bus=bus)
            run.watch(events.append)
            return await run.execute()

    return run_virtual(main()), events


def test_a_node_takes_its_time_and_ends_as_is_said() -> None:
    result, events = _run(_plan("- {at: root/act/left, outcome: done, after: 2 s}\n"))
    assert (result.outcome, result.duration_s, result.userdata) == ("good", 2.0, {"note": "moved"})
    assert result.stood_in_for == ("root/act/left",)
    kinds = {event.path: event.kind for event in events if isinstance(event, NodeEntered)}
    assert (kinds["root/act/left"], kinds["root/act/right"]) == ("substitute", "state")


def test_a_container_is_stood_in_for_whole() -> None:
    """Nothing inside it is entered; outputs of a container are userdata keys."""
    result, events = _run(_plan("- {at: root/act, outcome: done, outputs: {note: from a test}}\n"))
    assert (result.outcome, result.userdata) == ("good", {"note": "from a test"})
    assert not any(event.path.startswith("root/act/") for event in events if isinstance(event, NodeEntered))


def test_a_script_has_an_ending_for_each_activation() -> None:
    script = "[{outcome: c, after: 1}, {outcome: c, after: 1}, {outcome: a, after: 1}]"
    result, events = _run(_plan(f"- {{at: root/look, script: {script}}}\n- {{at: root/act/left, outcome: done}}\n"))
    assert (result.outcome, result.duration_s) == ("good", 3.0)
    assert [event.outcome for event in events if isinstance(event, NodeExited) and event.path == "root/look"] == [
        "c",
        "c",
        "a",
    ]


def test_an_error_goes_the_way_of_errors() -> None:
    result, _ = _run(_plan("- {at: root/act/left, error: the gripper is gone}\n"))
    assert result.outcome == "bad"
    assert result.cause is not None
    messages = [link.message for link in result.cause.chain()]
    assert "the gripper is gone (raised by the substitute at s.yaml:3:3)" in messages


def test_outputs_go_where_those_of_the_state_go() -> None:
    entries = "- {at: root/act/right, outcome: done, outputs: {value: scripted}}\n- {at: '**/left', outcome: done}\n"
    result, _ = _run(_plan(entries))
    assert result.userdata == {"note": "scripted"}


def test_another_state_is_run_instead() -> None:
    result, events = _run(_plan("- {at: root/act/left, state: test.Hurried, with: {}}\n"))
    assert result.outcome == "good"
    assert "substitute" in {event.kind for event in events if isinstance(event, NodeEntered)}


def test_leaves_of_trees_and_nodes_of_references_are_nodes_as_well(tmp_path: Path) -> None:
    (tmp_path / "inner.yaml").write_text(CHAIN, encoding="utf-8")
    wait = "{state: flow.Wait, with: {duration_s: 1000}, name: wait}"
    text = f"{HEAD}root: {{tree: {{sequence: [{wait}, {{behavior: inner.yaml}}]}}}}\n"
    (tmp_path / "outer.yaml").write_text(
        text.replace("[good, bad]", "[success, failure]").replace("[good]", "[success]")
    )
    ran = run_behavior(
        tmp_path / "outer.yaml",
        catalogue=WITH_FLOW,
        store=tmp_path / "s.db",
        substitutes={"root/sequence/wait": "done", "**/act/left": Hurried},
    )
    assert (ran.outcome, len(ran.result.stood_in_for)) == ("success", 2)


def test_tests_write_them_as_a_mapping(tmp_path: Path) -> None:
    (tmp_path / "chain.yaml").write_text(CHAIN, encoding="utf-8")
    ran = run_behavior(
        tmp_path / "chain.yaml",
        catalogue=WITH_FLOW,
        store=tmp_path / "s.db",
        substitutes={"root/look": ["c", SubstituteEnding(outcome="a", after="3 s")], "root/act": "failed"},
    )
    assert (ran.outcome, ran.result.duration_s) == ("bad", 3.0)
    assert ran.result.cause is not None
    assert "a substitute ended with failed" in [link.message for link in ran.result.cause.chain()]


@pytest.mark.parametrize(
    ("entry", "at", "says"),
    [
        ("{at: root/lok, outcome: a}", "root/lok", "`root/lok` matches no node of this behavior"),
        ("{at: root/look, outcome: d}", "d}", "`root/look` has no outcome `d`"),
        ("{at: root/look, script: [{outcome: a}, {outcome: d}]}", "d}", "`root/look` has no outcome `d`"),
        ("{at: root/act/right, outcome: done, outputs: {valeu: 1}}", "1}}", "has no output `valeu`"),
        ("{at: root/act/left, state: flow.Lgo}", "flow.Lgo", "there is no state `flow.Lgo`"),
        ("{at: root/act, state: flow.Log}", "flow.Log", "is a concurrency, which a state cannot replace"),
        ("{at: root/act/left, state: test.Give}", "test.Give", "has an outcome `a` without a transition here"),
        ("{at: root/look}", "{at", "has no ending"),
        ("{at: root/look, outcome: a, error: b}", "error", "both `outcome` and `error`"),
        ("{at: root/look, script: [{}]}", "{}", "has no ending"),
        ("{at: root/look, error: b, outputs: {x: 1}}", "outputs", "an error has no outputs"),
        ("{at: root/look, script: [{outcome: a}], after: 1 s}", "after", "`after` has no effect here"),
        ("{at: root/look, outcome: a, with: {}}", "with", "`with` has no effect here"),
    ],
)
def test_what_does_not_fit_is_reported_with_its_place(entry: str, at: str, says: str) -> None:
    with pytest.raises(DocumentError) as refusal:
        _plan(f"- {entry}\n")
    assert says in str(refusal.value)
    where = refusal.value.where
    assert isinstance(where, Position)
    assert f"- {entry}"[where.column - 1 :].startswith(at)


def test_no_real_robot_is_left_out_of_a_run_by_accident(tmp_path: Path) -> None:
    (tmp_path / "cell.yaml").write_text(
        "flexcell: 1\ncell: real\nrobots: {left: {model: panda, driver: {kind: other}}}\n", encoding="utf-8"
    )
    cell, plan = load_cell(tmp_path / "cell.yaml"), _plan("- {at: root/act, outcome: done}\n")
    with pytest.raises(ControlError, match=r"root/act has a substitute, but left is real"):
        require_simulation(plan, cell)
    require_simulation(plan, cell, allowed=True)
    require_simulation(new_plan(parse_behavior(CHAIN, file="test.yaml"), WITH_FLOW), cell)


@given(st.lists(st.sampled_from(["a", "b", "c"]), min_size=1, max_size=6))
def test_scripts_are_taken_in_turn_and_the_last_ending_stays(outcomes: list[str]) -> None:
    """Each activation of `look` takes the next: `c` leads back, `a` on to `act`, `b` past it."""
    script = ", ".join(f"{{outcome: {outcome}, after: 1}}" for outcome in [*outcomes, "a"])
    result, events = _run(_plan(f"- {{at: root/look, script: [{script}]}}\n- {{at: root/act, outcome: done}}\n"))
    decisive = next((index for index, outcome in enumerate([*outcomes, "a"]) if outcome != "c"), len(outcomes))
    assert result.duration_s == decisive + 1
    acted = any(event.path == "root/act" for event in events if isinstance(event, NodeEntered))
    assert (result.outcome, acted) == ("good", [*outcomes, "a"][decisive] == "a")
