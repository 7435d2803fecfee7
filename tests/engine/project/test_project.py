"""A project folder in a script: files are found from anywhere, and a run leaves what it is asked to leave."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine import DocumentError, Project, SkillBus
from engine.document.state_catalogue import StateCatalogue
from engine.event import FaultInjected
from engine.journal import list_runs
from engine.skills.gripper import ReadGripper
from tests.engine.faults.device import HEAD, STATES, Gripper

READ = """
root:
  machine:
    initial: read
    states:
      read: {state: gripper.Read, transitions: {read: good, failed: bad}}
"""
FILE = "behaviors/read.yaml"


@pytest.fixture
def project(tmp_path: Path) -> Project:
    """A project with one behavior, which reads a gripper."""
    (tmp_path / "behaviors").mkdir()
    (tmp_path / FILE).write_text(HEAD + READ, encoding="utf-8")
    (tmp_path / "faults.yaml").write_text("flexcell: 1\nfaults: [{error: no answer}]\n", encoding="utf-8")
    return Project(tmp_path, StateCatalogue(STATES))


def put_gripper_on(bus: SkillBus) -> None:
    """Serve the gripper of the left arm."""
    bus.advertise_service(ReadGripper, Gripper().read, namespace="left/gripper")


def test_files_are_found_from_any_folder(project: Project) -> None:
    assert project.check(FILE) == ()
    assert project.run(FILE, prepare=put_gripper_on).outcome == "good"


def test_a_run_is_kept_in_a_journal_only_if_one_is_given(project: Project) -> None:
    project.run(FILE, prepare=put_gripper_on)
    done = project.run(FILE, prepare=put_gripper_on, journal=project.folder / "journal")
    assert [(each.id, each.status) for each in list_runs(project.folder / "journal")] == [(done.result.run, "finished")]


def test_faults_are_injected_and_recorded(project: Project) -> None:
    recording = project.folder / "faulty.mcap"
    done = project.run(FILE, prepare=put_gripper_on, faults="faults.yaml", record=recording)
    assert done.outcome == "bad"
    assert any(isinstance(event, FaultInjected) for event in done.events)
    assert project.replay(recording).same


def test_a_behavior_with_errors_is_not_started(project: Project) -> None:
    broken = (project.folder / FILE).read_text(encoding="utf-8").replace("failed: bad", "failed: nowhere")
    (project.folder / FILE).write_text(broken, encoding="utf-8")
    opened: list[SkillBus] = []
    with pytest.raises(DocumentError, match="nowhere"):
        project.run(FILE, prepare=opened.append)
    assert opened == []
