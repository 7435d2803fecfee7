"""`flexcell resume`: after `kill -9` a run goes on from what was durable, and ends as it would have."""

from __future__ import annotations

import json
import os
import pty
import resource
import subprocess
from pathlib import Path

import pytest

from engine.event import BehaviorChanged, GateReached, NodeEntered, RunResumed, ServiceCalled
from engine.journal import list_runs
from tests.engine.cli.command import FLEXCELL, flexcell
from tests.engine.cli.process import JOURNAL, entered, events_in, run_id_in, runs_in, started, until

CELL = "flexcell: 1\ncell: shelf\nstore: {kind: sqlite, path: store.db}\n"
LOOP = """
flexcell: 1
name: rounds
cell: cell.yaml
parameters: {pause: {type: number, default: 0.05}, rounds: {type: integer, default: 6}}
userdata: {round: 0, entry: {round: 0}}
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: wait
    states:
      wait: {state: flow.Wait, with: {duration_s: "${pause}"}, transitions: {done: count}}
      count: {state: flow.SetValue, with: {value: "${round + 1}"}, out: {value: round}, transitions: {done: make}}
      make:
        state: flow.SetValue
        with: {value: "${{'round': round}}"}
        out: {value: entry}
        transitions: {done: write}
      write:
        state: store.WriteEntry
        with: {kind: record, name: rounds}
        in: {value: entry}
        transitions: {written: enough, conflict: failed}
      enough: {state: flow.Decide, with: {when: "${round >= rounds}"}, transitions: {"true": finished, "false": wait}}
"""
TWO = """
flexcell: 1
name: two
outcomes: [finished, other]
success: [finished]
root:
  machine:
    initial: first
    states:
      first: {state: flow.Wait, with: {duration_s: 0.01}, transitions: {done: second}}
      second: {state: flow.Wait, resume: RESUME, with: {duration_s: 3000}, transitions: {done: finished}}
"""


def written(folder: Path, text: str) -> Path:
    """Write the cell and a behavior."""
    (folder / "cell.yaml").write_text(CELL, encoding="utf-8")
    file = folder / "behavior.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def killed(folder: Path, text: str, *options: str, at: str, visit: int = 1) -> str:
    """Run a behavior and kill its process when a node has been entered durably; return the run."""
    file = written(folder, text)
    with started("run", file, "-q", *options, cwd=folder) as process:
        until(process, folder, entered(at, visit))
        process.kill()
        process.wait()
    return run_id_in(folder)


def test_a_killed_run_ends_as_it_would_have(tmp_path: Path) -> None:
    """Parameters, userdata and the number of rounds are those of the run; every round was written."""
    run = killed(tmp_path, LOOP, "-p", "rounds=30", "-p", "pause=0.2", at="root/write", visit=2)
    assert runs_in(tmp_path)[0].interrupted
    said = flexcell("resume", run, "--clock", "virtual", "--json", cwd=tmp_path)
    result = json.loads(said.out)
    assert (said.code, result["run"], result["outcome"]) == (0, run, "finished")
    assert result["userdata"] == {"round": 30, "entry": {"round": 30}}
    rounds = [event.request["value"] for event in events_in(tmp_path) if isinstance(event, ServiceCalled)]
    assert [{"round": n} for n in range(1, 31)] == [value for i, value in enumerate(rounds) if value not in rounds[:i]]
    assert [event.epoch for event in events_in(tmp_path) if isinstance(event, RunResumed)] == [2]
    assert [event.seq for event in events_in(tmp_path)] == list(range(1, len(events_in(tmp_path)) + 1))
    assert runs_in(tmp_path)[0].status == "finished"


def test_it_may_crash_again_and_again(tmp_path: Path) -> None:
    """Each engine is killed two rounds after it began."""
    run = killed(tmp_path, LOOP, "-p", "rounds=80", "-p", "pause=0.2", at="root/wait", visit=2)
    for _ in range(2):
        known = events_in(tmp_path)[-1].seq
        with started("resume", run, "-q", cwd=tmp_path) as process:
            until(process, tmp_path, lambda events, known=known: events[-1].seq > known + 20)
            process.kill()
            process.wait()
    said = flexcell("resume", run, "--clock", "virtual", "--json", cwd=tmp_path)
    assert (said.code, json.loads(said.out)["userdata"]["round"]) == (0, 80)
    assert list_runs(tmp_path / JOURNAL)[0].epoch == 4


def test_a_run_killed_before_anything_was_durable_begins_anew_with_its_parameters(tmp_path: Path) -> None:
    file = written(tmp_path, LOOP)
    with started(
        "run", file, "-q", "-p", "rounds=2", "--input", "round=1", "-p", "pause=1000", cwd=tmp_path
    ) as process:
        until(process, tmp_path, lambda events: bool(runs_in(tmp_path)))
        process.kill()
        process.wait()
    run = run_id_in(tmp_path)
    said = flexcell("resume", run, "--clock", "virtual", "--json", cwd=tmp_path)
    assert (said.code, json.loads(said.out)["userdata"]["round"]) == (0, 2)


@pytest.mark.parametrize(
    ("policy", "answer"), [("ask", "root/second=done"), ("done", ""), ("rerun", "root/second=done")]
)
def test_policies_and_answers_decide_about_a_state_in_mid_work(tmp_path: Path, policy: str, answer: str) -> None:
    run = killed(tmp_path, TWO.replace("RESUME", policy), at="root/second")
    said = flexcell("resume", run, "--json", *(("--answer", answer) if answer else ()), cwd=tmp_path)
    assert (said.code, json.loads(said.out)["outcome"]) == (0, "finished")


def test_a_question_without_answer_is_one_line_and_nothing_is_started(tmp_path: Path) -> None:
    run = killed(tmp_path, TWO.replace("RESUME", "ask"), at="root/second")
    said = flexcell("resume", run, cwd=tmp_path)
    assert (said.code, said.out) == (2, "")
    assert said.err == "root/second: was active, how to resume? --answer root/second=… (rerun, done)\n"
    wrong = flexcell("resume", run, "--answer", "root/second=dnoe", cwd=tmp_path)
    assert (wrong.code, wrong.err) == (2, "flexcell: root/second: there is no outcome 'dnoe' (did you mean done?)\n")
    assert runs_in(tmp_path)[0].epoch == 1


def test_a_changed_behavior_is_refused_unless_asked_for_and_possible(tmp_path: Path) -> None:
    text = TWO.replace("RESUME", "rerun")
    run = killed(tmp_path, text, at="root/second")
    file = written(tmp_path, text.replace("duration_s: 3000", "duration_s: 0.02"))
    said = flexcell("resume", run, cwd=tmp_path)
    assert said.code == 2
    assert "the behavior two has changed since" in said.err
    written(tmp_path, text.replace("second", "last"))
    said = flexcell("resume", run, "--changed", cwd=tmp_path)
    assert said.code == 2
    assert "root/second is active and not in the new version" in said.err
    written(
        tmp_path,
        text.replace("flow.Wait, resume: rerun", "flow.Log, resume: rerun").replace("duration_s: 3000", "message: hi"),
    )
    said = flexcell("resume", run, "--changed", cwd=tmp_path)
    assert said.code == 2
    assert "root/second is active as flow.Wait and becomes flow.Log" in said.err
    file.write_text(text.replace("duration_s: 3000", "duration_s: 0.02"), encoding="utf-8")
    said = flexcell("resume", run, "--changed", cwd=tmp_path)
    assert said.code == 0
    assert "changed: root/second has changed parameters" in said.err


def test_a_run_that_was_changed_while_it_ran_is_resumed_in_that_version(tmp_path: Path) -> None:
    text = TWO.replace("RESUME", "rerun")
    file = written(tmp_path, text)
    with started("run", file, "-q", "--operator", "--paused", cwd=tmp_path) as process:
        assert process.stdin is not None
        until(process, tmp_path, lambda events: any(isinstance(e, GateReached) for e in events))
        written(tmp_path, text.replace("second", "last").replace("3000", "2999"))
        process.stdin.write("reload\nresume\n")
        process.stdin.flush()
        until(process, tmp_path, entered("root/last"))
    said = flexcell("resume", run_id_in(tmp_path), "--clock", "virtual", "--json", cwd=tmp_path)
    assert (said.code, json.loads(said.out)["outcome"]) == (0, "finished")


def test_a_run_whose_running_state_was_given_up_for_another_class_is_resumed_with_that(tmp_path: Path) -> None:
    """The engine is killed in the state that was entered anew; without the word nothing is given up."""
    text = TWO.replace("RESUME", "rerun")
    file = written(tmp_path, text)
    with started("run", file, "-q", "--operator", cwd=tmp_path) as process:
        assert process.stdin is not None
        until(process, tmp_path, entered("root/second"))
        written(tmp_path, text.replace("with: {duration_s: 3000}", "with: {duration_s: 2999}"))
        process.stdin.write("pause\nwait\nreload preempt\nresume\n")
        process.stdin.flush()
        until(
            process,
            tmp_path,
            lambda events: sum(isinstance(e, NodeEntered) and e.path == "root/second" for e in events) > 1,
        )
    changes = [event for event in events_in(tmp_path) if isinstance(event, BehaviorChanged)]
    assert [event.restarted for event in changes] == [("root/second",)]
    assert "2999" in "".join(changes[0].documents.values())
    said = flexcell("resume", run_id_in(tmp_path), "--clock", "virtual", "--json", cwd=tmp_path)
    assert (said.code, json.loads(said.out)["outcome"]) == (0, "finished")


def test_hardware_is_asked_about_when_an_operator_is_demanded_now(tmp_path: Path) -> None:
    """A state that commands no hardware is not."""
    run = killed(tmp_path, TWO.replace("resume: RESUME, ", ""), at="root/second")
    said = flexcell("resume", run, "--demand-operator", "--clock", "virtual", "-q", cwd=tmp_path)
    assert said.code == 0


def test_a_run_that_a_process_drives_is_left_alone_or_taken_over(tmp_path: Path) -> None:
    """The engine that drove it before can write no more: it stops, says so, and ends with 3."""
    file = written(tmp_path, LOOP)
    with started("run", file, "--json", "-p", "rounds=1000000", cwd=tmp_path) as before:
        until(before, tmp_path, entered("root/write", 2))
        run = run_id_in(tmp_path)
        refused = flexcell("resume", run, cwd=tmp_path)
        assert (refused.code, refused.err) == (
            2,
            f"flexcell: {run}: process {before.pid} executes this run "
            "(stop that process first, or use `--take-over`, which stops its run)\n",
        )
        with started("resume", run, "--take-over", "-q", cwd=tmp_path) as after:
            out, _ = before.communicate(timeout=60)
            result = json.loads(out)
            assert (before.returncode, result["status"]) == (3, "errored")
            assert "is driven by another engine now (epoch 2)" in str(result["cause"])
            count = len(events_in(tmp_path))
            until(after, tmp_path, lambda events: len(events) > count + 10)
    assert [event.seq for event in events_in(tmp_path)] == list(range(1, len(events_in(tmp_path)) + 1))


def test_a_full_disk_ends_the_run_with_the_reason(tmp_path: Path) -> None:
    """The limit on the size of files stands in for the disk."""
    file = written(tmp_path, LOOP)
    with started("run", file, "--json", "-p", "rounds=1000000", cwd=tmp_path) as process:
        until(process, tmp_path, entered("root/write", 2))
        size = (tmp_path / JOURNAL / "journal.db-wal").stat().st_size
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (size, size))
        out, errors = process.communicate(timeout=60)
    result = json.loads(out)
    assert (process.returncode, result["status"], errors) == (3, "errored", "")
    assert "journal.db" in str(result["cause"])
    assert "the journal cannot be written" in str(result["cause"])
    assert flexcell("resume", run_id_in(tmp_path), "--timeout", "0.5", cwd=tmp_path).code == 1


def test_a_journal_that_cannot_be_opened_starts_nothing(tmp_path: Path) -> None:
    file = written(tmp_path, LOOP)
    (tmp_path / "taken").write_text("no directory", encoding="utf-8")
    said = flexcell("run", file, "--journal", "taken/journal", cwd=tmp_path)
    assert (said.code, said.err.count("\n")) == (2, 1)
    assert "the journal cannot be opened" in said.err


def test_what_is_no_interrupted_run_is_refused(tmp_path: Path) -> None:
    file = written(tmp_path, LOOP)
    assert flexcell("run", file, "--clock", "virtual", "-q", "-p", "rounds=1", cwd=tmp_path).code == 0
    over = flexcell("resume", run_id_in(tmp_path), cwd=tmp_path)
    assert over.code == 2
    assert "this run is over (finished)" in over.err
    unknown = flexcell("resume", run_id_in(tmp_path) + "x", cwd=tmp_path)
    assert (unknown.code, "did you mean" in unknown.err) == (2, True)


def test_on_a_terminal_it_asks_until_the_answer_fits(tmp_path: Path) -> None:
    run = killed(tmp_path, TWO.replace("RESUME", "ask"), at="root/second")
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        [FLEXCELL, "resume", run, "-q"], cwd=tmp_path, stdin=theirs, stderr=theirs, stdout=subprocess.PIPE
    ) as process:
        os.close(theirs)
        os.write(ours, b"perhaps\ndone\n")
        shown = b""
        while b"finished" not in shown:
            shown += os.read(ours, 4096)
        process.communicate(timeout=60)
    os.close(ours)
    assert process.returncode == 0
    assert shown.count(b"root/second was active: rerun, done?") == 2
