"""`flexcell runs` lists and shows runs; `flexcell run --from` begins at a moment of one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from engine.event import Event, NodeEntered, NodeExited, RunEnded
from tests.engine.cli.command import CommandOutput, flexcell
from tests.engine.cli.process import entered, events_in, run_id_in, started, until

STEPS = """
flexcell: 1
name: steps
parameters: {factor: {type: number, default: 2.0}, long: {type: number, default: 1.0}}
userdata: {value: 1}
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: one
    states:
      one: {state: flow.SetValue, with: {value: "${value + 1}"}, transitions: {done: two}}
      two:
        machine:
          initial: wait
          states:
            wait: {state: flow.Wait, with: {duration_s: "${long}"}, transitions: {done: times}}
            times: {state: flow.SetValue, with: {value: "${double(value) * factor}"}, transitions: {done: out}}
        transitions: {out: three}
      three: {state: flow.SetValue, with: {value: "${double(value) + 100.0}"}, transitions: {done: decide}}
      decide: {state: flow.Decide, with: {when: "${value > 0.0}"}, transitions: {"true": finished, "false": failed}}
"""


@pytest.fixture
def behavior(tmp_path: Path) -> Path:
    """A behavior in a directory of its own."""
    file = tmp_path / "steps.yaml"
    file.write_text(STEPS, encoding="utf-8")
    return file


def is_over(last: Event) -> bool:
    """Tell whether this is the last event of a run that has ended."""
    return isinstance(last, RunEnded)


def finished(behavior: Path, *options: str) -> CommandOutput:
    """Run it in virtual time."""
    return flexcell("run", behavior, "--clock", "virtual", "-q", *options, cwd=behavior.parent)


def test_runs_are_listed_with_their_state(behavior: Path) -> None:
    """Finished, under way, and interrupted."""
    folder = behavior.parent
    assert flexcell("runs", cwd=folder).code == 2
    finished(behavior)
    with started("run", behavior, "-q", "-p", "long=3000", cwd=folder) as process:
        until(process, folder, lambda events: entered("root/two/wait")(events) and not is_over(events[-1]))
        lines = json.loads(flexcell("runs", "--json", cwd=folder).out)
        assert [(line["behavior"], line["status"]) for line in lines] == [("steps", "finished"), ("steps", "running")]
    said = flexcell("runs", cwd=folder)
    assert (said.code, said.err) == (0, "")
    words = [line.split() for line in said.out.splitlines()]
    assert [line[2] for line in words] == ["status", "finished", "interrupted"]
    assert words[2][0] == run_id_in(folder)
    # What a run that was killed took is known up to its last event.
    assert words[2][-3:-1] == [f"{events_in(folder)[-1].time_s:.2f}", "s"]
    assert [line["duration_s"] for line in lines] == [1.0, lines[1]["duration_s"]]


def test_a_run_is_shown_where_it_stood(behavior: Path) -> None:
    """Active states, data of every scope, parameters, the operator's doing, the last events."""
    folder = behavior.parent
    with started("run", behavior, "-q", "-p", "long=3000", "-p", "factor=3", "--operator", cwd=folder) as process:
        assert process.stdin is not None
        until(process, folder, entered("root/two/wait"))
        process.stdin.write("lock root/two\n")
        process.stdin.flush()
        until(process, folder, lambda events: "lock" in str(events[-1]))
    run = run_id_in(folder)
    shown = json.loads(flexcell("runs", "show", run, "--json", cwd=folder).out)
    assert (shown["status"], shown["active"]) == ("interrupted", ["root", "root/two", "root/two/wait"])
    assert (shown["userdata"], shown["parameters"]) == ({"value": 2}, {"factor": 3.0, "long": 3000.0})
    assert [(event["event"], event.get("command")) for event in shown["operator"]] == [
        ("operator", None),
        ("command", "lock"),
    ]
    assert shown["last"][-1]["event"] == "command"
    said = flexcell("runs", "show", run, cwd=folder)
    assert "  root/two/wait\n" in said.out
    assert "  value = 2\n" in said.out
    assert "root/two  operator: lock" in said.out
    listed = flexcell("runs", "show", run, "--events", cwd=folder).out.splitlines()
    assert [json.loads(line)["seq"] for line in listed] == list(range(1, len(events_in(folder)) + 1))


def test_the_end_of_a_run_is_shown_with_its_cause(behavior: Path) -> None:
    behavior.write_text(STEPS.replace("value > 0.0", "value < 0.0"), encoding="utf-8")
    assert finished(behavior).code == 1
    run = run_id_in(behavior.parent)
    said = flexcell("runs", "show", run, cwd=behavior.parent)
    assert "finished with failed" in said.out
    assert "\n  so root/decide ended with false\n" in said.out
    shown = json.loads(flexcell("runs", "show", run, "--json", cwd=behavior.parent).out)
    assert (shown["outcome"], shown["cause"][0]["message"]) == ("failed", "the condition is false")


def test_a_run_begins_at_a_moment_of_another(behavior: Path) -> None:
    """With the data of that event, at the state entered last by then, and with its parameters."""
    folder = behavior.parent
    finished(behavior, "-p", "factor=5")
    before = run_id_in(folder)
    seq = next(e.seq for e in events_in(folder) if isinstance(e, NodeEntered) and e.path == "root/two/times")
    said = finished(behavior, "--from", f"{before}@{seq}", "--json")
    result = json.loads(said.out)
    assert (said.code, said.err, result["userdata"]) == (0, "", {"value": 110.0})
    assert result["run"] != before
    paths = [e.path for e in events_in(folder) if isinstance(e, NodeEntered)]
    assert paths == ["root", "root/two", "root/two/times", "root/three", "root/decide"]


def test_it_may_begin_elsewhere_and_with_another_version(behavior: Path) -> None:
    folder = behavior.parent
    finished(behavior)
    before = run_id_in(folder)
    seq = next(e.seq for e in events_in(folder) if isinstance(e, NodeExited) and e.path == "root/one")
    behavior.write_text(STEPS.replace("+ 100.0", "+ 1000.0"), encoding="utf-8")
    said = finished(behavior, "--from", f"{before}@{seq}", "--at", "root/three", "-p", "factor=7", "--json")
    assert (said.code, json.loads(said.out)["userdata"]) == (0, {"value": 1002.0})


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (("--from", "{run}"), "is not RUN@SEQ"),
        (("--from", "{run}@0"), "has no event 0 (it has 1 to"),
        (("--from", "{run}@1"), "no state was entered before event 1"),
        (("--from", "{run}@5", "--at", "root/tow"), "root/tow: there is no such node (did you mean root/two"),
        (("--from", "nobody@5"), "there is no run nobody"),
        (("--at", "root/two"), "--at requires --from"),
    ],
)
def test_instants_that_are_not_there_start_nothing(behavior: Path, options: tuple[str, ...], reason: str) -> None:
    folder = behavior.parent
    finished(behavior)
    run = run_id_in(folder)
    said = finished(behavior, *(option.format(run=run) for option in options))
    assert (said.code, said.err.count("\n"), run_id_in(folder)) == (2, 1, run)
    assert reason in said.err
