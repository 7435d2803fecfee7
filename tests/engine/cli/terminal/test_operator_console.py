"""`flexcell run --operator`: commands line by line, questions answered, and what happens when nobody is there."""

from __future__ import annotations

import json
import signal
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import IO

import pytest

from engine.event import AnyEvent, GateReached, OperatorChanged, OperatorCommanded, RunEnded, StopRequested
from tests.engine.cli.command import CommandOutput, flexcell
from tests.engine.cli.process import entered, events_in, started, until

NESTED = """
flexcell: 1
name: nested
userdata: {n: 0}
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: one
    states:
      one: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: two}}
      two:
        machine:
          initial: left
          states:
            left: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: right}}
            right: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: out, }}
        autonomy: {out: high}
        transitions: {out: three}
      three: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: four}}
      four: {state: flow.Decide, with: {when: "${n == 0}"}, transitions: {"true": good, "false": bad}}
"""
DEAF = """
import asyncio
from typing import ClassVar

from engine.authoring import behavior, machine, state
from engine.state import Context, Outcome, State


class Deaf(State, frozen=True, kw_only=True):
    '''Never stop.'''

    state_name: ClassVar[str] = "deaf:Deaf"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        while True:
            try:
                await asyncio.get_running_loop().create_future()
            except asyncio.CancelledError:
                ctx.log("no")


ear = state(Deaf(), transitions={"done": "done"})
deaf = behavior("deaf", outcomes=["done"], root=machine(initial="ear", states={"ear": ear}))
"""


@pytest.fixture
def nested(tmp_path: Path) -> Path:
    """A machine in a machine whose outcome requires an operator."""
    file = tmp_path / "nested.yaml"
    file.write_text(NESTED, encoding="utf-8")
    return file


def operated(file: Path, script: str, *options: str) -> CommandOutput:
    """Run it in virtual time with these lines on standard input."""
    return flexcell("run", file, "--clock", "virtual", "--operator", *options, cwd=file.parent, stdin=script)


def commanded(folder: Path) -> list[str]:
    """Return what the journal knows of the operator."""
    return [f"{e.command} {e.path}".strip() for e in events_in(folder) if isinstance(e, OperatorCommanded)]


def gates(folder: Path) -> list[str]:
    """Return where the run waited."""
    return [f"{e.point} {e.path}" for e in events_in(folder) if isinstance(e, GateReached)]


def test_a_request_is_shown_and_answered(nested: Path) -> None:
    said = operated(nested, "wait\nanswer\n", "--autonomy", "low", "--operator-loss", "continue")
    assert said.code == 0
    assert "? root/two asks for out, which requires high: answer root/two | force root/two OUTCOME" in said.err
    assert commanded(nested.parent) == ["answer root/two"]
    assert [e.status for e in events_in(nested.parent) if isinstance(e, OperatorChanged)] == ["attached", "detached"]


def test_steps_breakpoints_locks_and_orders(nested: Path) -> None:
    script = """
    break root/two/left if n == 0
    wait
    where
    step
    wait
    clear
    lock root/two
    resume
    wait
    repeat root/two
    unlock root/two
    wait
    force root/two out
    detach
    """
    said = operated(nested, script.replace("    ", ""), "--autonomy", "low")
    assert said.code == 0
    assert gates(nested.parent) == [
        "before root/two/left", "before root/two/right", "after root/two", "after root/two",
    ]  # fmt: skip
    assert "paused, autonomy low, operator attached\n  before root/two/left: pause\n" in said.err
    assert "break root/two/left before if n == 0" in said.err
    assert commanded(nested.parent) == [
        "breakpoints", "step", "breakpoints", "lock root/two", "resume", "repeat root/two", "unlock root/two",
        "force root/two",
    ]  # fmt: skip


def test_a_value_of_the_userdata_is_replaced_at_a_breakpoint(nested: Path) -> None:
    said = operated(
        nested, "break root/four\nwait\nset n\nset k 1\nset n 7 in behavior\nset n [1\nclear\nresume\ndetach\n"
    )
    assert said.code == 1
    for line in (
        "a key and a value as JSON are required, as in `set n 3`; usage: set KEY JSON [in CONTAINER]",
        "there is no userdata key 'k'",
    ):
        assert line in said.err
    assert commanded(nested.parent) == ["breakpoints", "set_userdata", "breakpoints", "resume"]


def test_steps_back_one_after_the_other(nested: Path) -> None:
    script = """
    break root/three
    wait
    back
    wait
    back root/two
    where
    back
    wait
    back
    clear
    resume
    detach
    """
    said = operated(nested, script.replace("    ", ""))
    assert said.code == 0
    assert commanded(nested.parent) == [
        "breakpoints", "step_back root/three", "step_back root/two", "breakpoints", "resume",
    ]  # fmt: skip
    for line in (
        "root/two stepped back before its entry",
        "root/one stepped back before its entry",
        "root/one: the run is at its beginning",
    ):
        assert line in said.err


def test_wrong_lines_are_answered_in_one_line_each_and_change_nothing(nested: Path) -> None:
    script = """stpe
lock
lock root/tow
force root/one
step
autonomy much
break root if 1 +
break a hits 0
answer
detach
"""
    said = operated(nested, script, "--quiet")
    assert said.code == 0
    lines = said.err.splitlines()[:9]
    assert [line.partition(" (")[0] for line in lines] == [
        "there is no command 'stpe'",
        "one path is required; usage: lock PATH",
        "root/tow: there is no such node",
        "a path and an outcome are required; usage: force PATH OUTCOME",
        "the run is not paused",
        "'much' is not one of off, low, high, full; usage: autonomy off|low|high|full",
        "`${1 +}`: Syntax error: mismatched input end",
        "'0' is not a positive integer; usage: break [PATH [after] [if EXPR] [hits N]]",
        "no question is open",
    ]
    assert commanded(nested.parent) == []


def test_a_new_version_of_the_file_takes_over(nested: Path) -> None:
    """The first line waits at the breakpoint; the file is changed; `reload` says what is different."""
    with started(
        "run", nested, "--operator", "--paused", "-q", "--operator-loss", "continue", cwd=nested.parent
    ) as process:
        assert process.stdin is not None
        until(process, nested.parent, lambda events: any(isinstance(e, GateReached) for e in events))
        nested.write_text(
            NESTED.replace("n == 0", "n == 1").replace("duration_s: 1", "duration_s: 0"), encoding="utf-8"
        )
        process.stdin.write("reload\nresume\n")
        process.stdin.close()
        process.stdin = None
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "changed: root/four has changed parameters" in errors


def test_breakpoints_beside_the_behavior_are_used_with_an_operator_only(nested: Path) -> None:
    beside = nested.with_name("nested.breakpoints.yaml")
    beside.write_text("flexcell: 1\nbreakpoints: [{path: root/three}]\n", encoding="utf-8")
    assert flexcell("run", nested, "--clock", "virtual", "-q", cwd=nested.parent).code == 0
    assert gates(nested.parent) == []
    assert operated(nested, "wait\nresume\ndetach\n").code == 0
    assert gates(nested.parent) == ["before root/three"]


@pytest.mark.parametrize(
    ("policy", "code", "reason"),
    [("continue", 0, ""), ("stop", 1, "the operator was lost"), ("hold", 3, "virtual time cannot advance")],
)
def test_the_end_of_input_is_the_operators_leaving(nested: Path, policy: str, code: int, reason: str) -> None:
    """Held for ever, virtual time cannot pass: that is an error, not a hang."""
    text = NESTED.replace("duration_s: 1}", "duration_s: 10}", 1)
    nested.write_text(text, encoding="utf-8")
    said = operated(nested, "", "--operator-loss", policy, "--json")
    assert said.code == code
    result = json.loads(said.out)
    assert reason in str(result["cause"])


def test_what_waits_for_ever_in_virtual_time_is_named_and_its_events_kept(nested: Path) -> None:
    """Nobody answers: exit code 3, one object on stdout, the event log written."""
    log = nested.with_name("log.jsonl")
    said = flexcell(
        "run", nested, "--clock", "virtual", "--autonomy", "low", "--demand-operator", "--json", "--events", log,
        cwd=nested.parent,
    )  # fmt: skip
    result = json.loads(said.out)
    assert (said.code, result["status"]) == (3, "errored")
    assert "waiting forever: root/two (autonomy)" in result["cause"][0]["message"]
    last = json.loads(log.read_text(encoding="utf-8").splitlines()[-1])
    assert (last["event"], last["status"]) == ("run_ended", "errored")


@pytest.mark.parametrize(
    "script", ["", "lock root/one\nresume\n", "autonomy off\nresume\n"], ids=["pause", "lock", "question"]
)
def test_a_signal_beats_pause_lock_and_question(nested: Path, script: str) -> None:
    """The run waits at its beginning until the command has come."""
    before, after = "duration_s: 1}, transitions: {done: two}", "duration_s: 0.1}, transitions: {done: two}"
    text = NESTED.replace(before, f"{after}, autonomy: {{done: low}}")
    nested.write_text(text, encoding="utf-8")
    with started("run", nested, "--operator", "--paused", "-q", cwd=nested.parent) as process:
        assert process.stdin is not None
        until(process, nested.parent, waits())
        if script:
            process.stdin.write(script)
            process.stdin.flush()
            until(process, nested.parent, waits("after root/one"))
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
    assert process.returncode == 130
    events = events_in(nested.parent)
    assert [e.reason for e in events if isinstance(e, StopRequested)] == ["interrupted by SIGINT"]


def test_a_run_is_paused_while_it_goes_on(nested: Path) -> None:
    nested.write_text(NESTED.replace("duration_s: 1", "duration_s: 20"), encoding="utf-8")
    with started("run", nested, "--operator", "-q", cwd=nested.parent) as process:
        assert process.stdin is not None
        until(process, nested.parent, entered("root/one"))
        process.stdin.write("pause\n")
        process.stdin.flush()
        until(process, nested.parent, lambda events: any(isinstance(e, OperatorCommanded) for e in events))
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
    assert process.returncode == 130
    assert commanded(nested.parent) == ["pause"]


def waits(at: str = "") -> Callable[[Sequence[AnyEvent]], bool]:
    """Tell whether the run has come to a gate, or to this one."""
    return lambda events: any(isinstance(e, GateReached) and f"{e.point} {e.path}".endswith(at) for e in events)


def test_the_second_signal_says_what_is_waited_for_and_the_third_leaves(tmp_path: Path) -> None:
    (tmp_path / "deaf.py").write_text(DEAF, encoding="utf-8")
    with started("run", "deaf.py:deaf", cwd=tmp_path) as process:
        assert process.stderr is not None
        until(process, tmp_path, entered("root/ear"))
        process.send_signal(signal.SIGINT)
        read_until(process.stderr, "no")
        process.send_signal(signal.SIGINT)
        read_until(process.stderr, "waiting for root/ear to come to rest; press Ctrl-C again to exit immediately")
        process.send_signal(signal.SIGINT)
        read_until(process.stderr, "exited immediately")
        process.wait(timeout=60)
    assert process.returncode == 130


def test_a_state_that_never_stops_is_abandoned_and_the_process_ends(tmp_path: Path) -> None:
    """The result is told, the journal closed, and no exit handler waits for it."""
    (tmp_path / "deaf.py").write_text(DEAF, encoding="utf-8")
    said = flexcell("run", "deaf.py:deaf", "--clock", "virtual", "--timeout", "5", "--json", cwd=tmp_path)
    result = json.loads(said.out)
    assert (said.code, result["status"]) == (3, "errored")
    assert said.err.endswith("flexcell: abandoned: root/ear; the process exits without waiting for it\n")
    assert isinstance(events_in(tmp_path)[-1], RunEnded)


def read_until(stream: IO[str], text: str) -> None:
    """Read lines up to one that holds the text."""
    for line in stream:
        if text in line:
            return
    raise AssertionError(f"it never said {text!r}")
