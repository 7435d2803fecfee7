"""`flexcell run`: outcome as exit code, JSON for machines, a clean stop on signals."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

from engine.event import RunEnded, StopRequested
from engine.host.thread_switch_interval import INTERVAL_S
from engine.journal import list_runs, read_events
from tests.engine.awaited import wait_until
from tests.engine.cli.command import FLEXCELL, flexcell
from tests.engine.project_folder import STATE, ProjectFolder

COUNT = """
flexcell: 1
name: wait
parameters: {pause: {type: number, default: 1.0, minimum: 0, maximum: 3600, unit: s}}
userdata: {flag: true}
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: wait
    states:
      wait: {state: flow.Wait, with: {duration_s: "${pause}"}, transitions: {done: choose}}
      choose: {state: flow.Decide, with: {when: "${flag}"}, transitions: {"true": finished, "false": failed}}
"""

PROMPTLY = f"""\
import sys
        if sys.getswitchinterval() > 1.01 * {INTERVAL_S}:
            raise TimeoutError(sys.getswitchinterval())
        return Outcome("done")"""


@pytest.fixture
def behavior(tmp_path: Path) -> Path:
    """A behavior that waits and then decides by its userdata."""
    file = tmp_path / "wait.yaml"
    file.write_text(COUNT, encoding="utf-8")
    return file


def test_a_success_is_exit_code_0_and_one_json_object(behavior: Path) -> None:
    """An hour passes in a moment; the object tells the whole result."""
    said = flexcell("run", behavior, "--clock", "virtual", "--json", "-p", "pause=3600", cwd=behavior.parent)
    result = json.loads(said.out)
    assert (said.code, said.err) == (0, "")
    assert (result["outcome"], result["success"], result["duration_s"], result["cause"]) == (
        "finished", True, 3600.0, [],
    )  # fmt: skip


def test_another_outcome_is_exit_code_1_with_its_cause(behavior: Path) -> None:
    """Inputs change the way the behavior takes."""
    said = flexcell("run", behavior, "--clock", "virtual", "--json", "--input", "flag=false", cwd=behavior.parent)
    assert (said.code, json.loads(said.out)["outcome"]) == (1, "failed")


def test_twice_the_same_seed_writes_the_same_event_log(behavior: Path) -> None:
    """Byte for byte, in two processes."""
    logs = [behavior.with_name(f"{n}.jsonl") for n in (1, 2)]
    for log in logs:
        flexcell("run", behavior, "--clock", "virtual", "--seed", "7", "--events", log, "-q", cwd=behavior.parent)
    first, second = (log.read_bytes() for log in logs)
    assert first == second
    assert first.count(b"\n") > 5


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("-p", "puase=1"), "there is no parameter `puase` (did you mean pause?)"),
        (("-p", "pause=-1"), "-1 is below the minimum 0 s"),
        (("-p", "pause=soon"), "parameter `pause`: 'soon' is not a number"),
        (("-p", "pause"), "'pause' is not name=value"),
        (("--input", "flag=no"), "'no' is not JSON"),
        (("--input", "flg=1"), "there is no userdata key 'flg' (did you mean flag?)"),
        (("--cell", "nowhere.yaml"), "nowhere.yaml:1:1: cannot read this file"),
    ],
)
def test_bad_usage_is_exit_code_2_and_one_line(behavior: Path, arguments: tuple[str, ...], message: str) -> None:
    """Nothing is started and the line says what to do."""
    said = flexcell("run", behavior, "--clock", "virtual", *arguments, cwd=behavior.parent)
    assert (said.code, said.out, said.err.count("\n")) == (2, "", 1)
    assert message in said.err


def test_a_document_with_several_mistakes_is_refused_with_the_first_and_their_number(behavior: Path) -> None:
    """One line, with the command that tells them all."""
    text = behavior.read_text(encoding="utf-8")
    behavior.write_text(f"flavour: 1\n{text}colour: 2\n", encoding="utf-8")
    said = flexcell("run", behavior.name, "--clock", "virtual", cwd=behavior.parent)
    assert (said.code, said.err.count("\n")) == (2, 1)
    assert said.err.startswith(f"flexcell: {behavior.name}:1:1: unknown key `flavour`")
    assert said.err.endswith(f"; 1 more: flexcell check {behavior.name}\n")


def test_an_error_in_a_state_is_exit_code_3_with_its_cause(tmp_path: Path) -> None:
    """A state that asks for a store that is not there ends the run with the reason."""
    file = tmp_path / "read.yaml"
    decide = 'choose: {state: flow.Decide, with: {when: "${flag}"}, transitions: {"true": finished, "false": failed}}'
    transitions = "transitions: {found: finished, missing: failed}"
    read = "choose: {state: store.ReadEntry, with: {kind: pose, name: home}, " + transitions + "}"
    file.write_text(COUNT.replace(decide, read), encoding="utf-8")
    said = flexcell("run", file, "--clock", "virtual", "--json", cwd=tmp_path)
    result = json.loads(said.out)
    assert (said.code, result["status"]) == (3, "errored")
    assert "no such service" in str(result["cause"])


def test_a_timeout_stops_the_run(behavior: Path) -> None:
    """`--timeout` is on the run's own clock."""
    said = flexcell(
        "run", behavior, "--clock", "virtual", "--json", "-p", "pause=100", "--timeout", "5", cwd=behavior.parent
    )
    result = json.loads(said.out)
    assert (said.code, result["status"], result["duration_s"]) == (1, "stopped", 5.0)
    assert "the run took longer than 5 s" in result["cause"][0]["message"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_the_run_and_closes_the_journal(behavior: Path, number: signal.Signals) -> None:
    """Exit code 130, and the journal tells who asked."""
    command = [FLEXCELL, "run", behavior, "-p", "pause=3000", "--journal", "journal"]
    with subprocess.Popen(command, cwd=behavior.parent, stderr=subprocess.PIPE, text=True) as process:
        journal = behavior.parent / "journal" / "journal.db"

        def is_running() -> bool:
            assert process.poll() is None
            return journal.exists() and _running(journal)

        wait_until(is_running)
        process.send_signal(number)
        _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    (run,) = list_runs(journal)
    events = read_events(journal, run.id)
    stops = [event.reason for event in events if isinstance(event, StopRequested)]
    assert (run.status, stops, isinstance(events[-1], RunEnded)) == (
        "stopped", [f"interrupted by {number.name}"], True,
    )  # fmt: skip
    assert "stopped after" in errors


def _running(journal: Path) -> bool:
    try:
        return bool(list_runs(journal))
    except Exception:  # the file is being made
        return False


def test_the_version_is_printed_without_loading_the_rest() -> None:
    """By the installed script."""
    imported = "import sys; sys.argv[1:] = ['--version']; from engine.cli.entry import main; main(); "
    done = subprocess.run(
        [sys.executable, "-c", f"{imported} sys.exit('typer' in sys.modules or 'msgspec' in sys.modules)"],
        capture_output=True,
        text=True,
        check=False,
    )
    script = subprocess.run([FLEXCELL, "--version"], capture_output=True, text=True, check=False)
    assert (done.returncode, script.returncode) == (0, 0)
    assert done.stdout == script.stdout == f"flexcell {version('flexcell')}\n"


def test_a_run_is_refused_where_its_cell_lacks_what_it_names(tmp_path: Path) -> None:
    """By default, by what it is given and in another cell; nothing is started, and one line says why."""
    for cell, robot in (("own", "left"), ("other", "arm")):
        text = f"flexcell: 1\ncell: {cell}\nworld: {{kind: mujoco}}\nrobots: {{{robot}: {{model: servo_arm}}}}\n"
        (tmp_path / f"{cell}.yaml").write_text(text, encoding="utf-8")
    text = COUNT.replace("name: wait\n", "name: wait\ncell: own.yaml\n", 1)
    text = text.replace("parameters: {", "parameters: {arm: {type: string, default: left}, ")
    text = text.replace(
        'state: flow.Decide, with: {when: "${flag}"}', 'state: motion.SetSpeed, with: {robot: "${arm}", share: 0.5}'
    )
    text = text.replace('"true": finished, "false": failed', "set: finished, failed: failed")
    (tmp_path / "b.yaml").write_text(text, encoding="utf-8")
    for arguments, line in (
        (("-p", "arm=lft"), "the cell own has no robot `lft`, which `${arm}` is (did you mean left?)"),
        (("--cell", "other.yaml"), "the cell other has no robot `left`, which `${arm}` is by default (known: arm)"),
        (("--cell", "other.yaml", "-p", "arm=am"), "the cell other has no robot `am`, which"),
    ):
        said = flexcell("run", "b.yaml", "--clock", "virtual", "-q", *arguments, cwd=tmp_path)
        assert (said.code, line in said.err, "Traceback" in said.err) == (2, True, False), said
    assert not (tmp_path / ".flexcell").exists()
    said = flexcell("run", "b.yaml", "--clock", "virtual", "-q", "--cell", "other.yaml", "-p", "arm=arm", cwd=tmp_path)
    assert (said.code, "has no robot" in said.err) == (0, False), said


def test_states_run_beside_threads_that_leave_the_loop_its_turn(tmp_path: Path) -> None:
    """A state sees the interval after which Python takes the interpreter from a thread."""
    project = ProjectFolder(tmp_path)
    module = project.module(STATE.replace('return Outcome("done")', PROMPTLY))
    project.allow(module)
    project.behavior("nod", f"{module}:Nod")
    said = flexcell("run", "behaviors/nod.yaml", "--clock", "virtual", "-q", cwd=tmp_path)
    assert said.code == 0, said.err


def test_motion_is_permitted_with_a_reason_or_not_at_all(behavior: Path) -> None:
    """Usage, so nothing has been opened."""
    said = flexcell("run", behavior, "--enable", " ", cwd=behavior.parent)
    assert said.code == 2
    assert "say in words why it is permitted" in said.err
