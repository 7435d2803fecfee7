"""The pytest plugin in a project of its own: recordings are tests, fixtures run behaviors."""

from __future__ import annotations

import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import pytest

from engine.clock import run_virtual
from tests.engine.cli.command import flexcell
from tests.engine.replay.rig import record_run
from tests.tiers import nightly

WAIT = """flexcell: 1
name: wait
parameters: {pause: {type: number, default: 60, minimum: 0, unit: s}}
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


@dataclass(frozen=True)
class PytestOutput:
    """What pytest printed and its exit code."""

    code: int
    out: str


def run_pytest(project: Path, *arguments: str) -> PytestOutput:
    """Run pytest in a project, with nothing of this one but what is installed."""
    environment = {key: value for key, value in os.environ.items() if not key.startswith(("PYTEST", "COV"))}
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *arguments],
        cwd=project,
        env=environment,
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    return PytestOutput(done.returncode, done.stdout + done.stderr)


def record(project: Path, name: str) -> None:
    """Record a run of the behavior `wait` into a folder of the project."""
    (project / "recordings").mkdir(exist_ok=True)
    (project / "wait.yaml").write_text(WAIT, encoding="utf-8")
    given = ("wait.yaml", "--clock", "virtual", "-q", "--journal", "none", "--record", f"recordings/{name}.mcap")
    assert flexcell("run", *given, cwd=project).code == 0


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with one good recording and one that this installation cannot replay."""
    record(tmp_path, "good")
    run_virtual(record_run("root: {state: test.Give}", tmp_path / "recordings" / "strange.mcap"))
    (tmp_path / "pytest.ini").write_text("[pytest]\nflexcell_recordings = recordings\n", encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize(
    "parallel", [(), nightly(("-n", "2")), nightly(("-p", "no:randomly"))], ids=["plain", "xdist", "in order"]
)
def test_each_recording_is_a_test(project: Path, parallel: tuple[str, ...]) -> None:
    tested = run_pytest(project, "-rA", *parallel)
    assert tested.code == 1
    assert "PASSED recordings/good.mcap::good" in tested.out
    assert "strange.mcap:" in tested.out
    assert "there is no state `test.Give`" in tested.out
    assert "1 failed, 1 passed" in tested.out
    assert "Traceback" not in tested.out


def test_the_failure_is_the_difference(project: Path) -> None:
    """A state of the project that does something else since."""
    (project / "recordings" / "strange.mcap").unlink()
    (project / "conftest.py").write_text(
        "from states.flow.decide import Decide\n"
        "from engine.state import Outcome\n"
        "async def run(self, ctx): return Outcome('false')\n"
        "Decide.run = run\n",
        encoding="utf-8",
    )
    tested = run_pytest(project, "--junit-xml", "r.xml")
    assert tested.code == 1
    line = "event 7 at 60.000 s, root/choose: recorded `ended with true`; "
    line += 'replayed `ended with false` (outcome: "true" ≠ "false")'
    assert line in tested.out
    assert "Traceback" not in tested.out
    case = ET.parse(project / "r.xml").getroot().find("./testsuite/testcase")
    assert case is not None
    assert {each.get("name") for each in case.iter("property")} == {"run", "document_sha256"}


def test_a_folder_can_be_given_on_the_command_line(project: Path) -> None:
    (project / "pytest.ini").unlink()
    (project / "tests").mkdir()
    (project / "tests" / "test_one.py").write_text("def test_one(): pass\n", encoding="utf-8")
    assert "1 passed" in run_pytest(project, "tests").out
    tested = run_pytest(project, "tests", "--flexcell-recordings", "recordings", "-m", "flexcell_replay", "-n", "2")
    assert "1 failed, 1 passed" in tested.out


def test_without_recordings_it_does_nothing(project: Path) -> None:
    (project / "pytest.ini").unlink()
    tested = run_pytest(project, "recordings")
    assert "collected 0 items" in tested.out


FIXTURES = """
import sys

def test_a_behavior(flexcell_run):
    ran = flexcell_run("wait.yaml", parameters={"pause": 3600})
    assert (ran.outcome, ran.result.duration_s) == ("finished", 3600.0)
    assert [event.path for event in ran.events if type(event).__name__ == "NodeEntered"] == [
        "root", "root/wait", "root/choose",
    ]

def test_other_inputs(flexcell_run):
    assert flexcell_run("wait.yaml", inputs={"flag": False}).outcome == "failed"

def test_a_recording(flexcell_replay):
    assert flexcell_replay("recordings/good.mcap").same
    assert "mujoco" not in sys.modules
"""


def test_fixtures_run_and_replay(project: Path) -> None:
    (project / "test_fixtures.py").write_text(FIXTURES, encoding="utf-8")
    tested = run_pytest(project, "test_fixtures.py")
    assert "3 passed" in tested.out, tested.out


def test_the_engine_is_imported_only_when_it_is_needed(tmp_path: Path) -> None:
    (tmp_path / "test_one.py").write_text(
        "import sys\ndef test_one(): assert 'engine.runtime.run' not in sys.modules\n", encoding="utf-8"
    )
    assert "1 passed" in run_pytest(tmp_path).out
