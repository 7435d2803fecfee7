"""A session lists behaviors, runs any number of them at once, and closes with everything stopped."""

from __future__ import annotations

import sqlite3
import sys
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.document.loader import BehaviorSurvey, survey_behavior
from engine.errors import ControlError, DocumentError, FlexcellError, JournalError
from engine.journal import Journal, list_runs
from engine.library import behavior_library
from engine.project.session import Session
from engine.registry import load_states
from engine.runtime.control import Breakpoint
from tests.engine.fake_states import CATALOGUE
from tests.engine.project_folder import ProjectFolder, is_imported

BEHAVIOR = """
flexcell: 1
name: {name}
parameters: {{pause: {{type: number, default: 0.01, minimum: 0, maximum: 100}}}}
outcomes: [good]
success: [good]
root:
  machine:
    initial: wait
    states:
      wait: {{state: {state}, transitions: {{{outcome}: good}}}}
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with a quick behavior, an endless one and a broken one."""
    folder = tmp_path / "behaviors"
    folder.mkdir()
    quick = BEHAVIOR.format(name="quick", state='test.Give, with: {after_s: "${pause}"}', outcome="a: good, b: good, c")
    (folder / "quick.yaml").write_text(quick, encoding="utf-8")
    (folder / "endless.yaml").write_text(
        BEHAVIOR.format(name="endless", state="test.Use, with: {for_s: 1000}", outcome="done"), encoding="utf-8"
    )
    (folder / "broken.yaml").write_text("root: [", encoding="utf-8")
    (folder / "cell.yaml").write_text("flexcell: 1\ncell: c\n", encoding="utf-8")
    return tmp_path


@asynccontextmanager
async def _session(project: Path) -> AsyncGenerator[Session]:
    with Journal.open(project / "journal") as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=project, catalogue=CATALOGUE, journal=journal) as opened,
        ):
            yield opened


async def test_the_list_and_the_editor_read_a_document_once(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both look at the same library; a file that changes is read once more."""
    read: list[str] = []

    def survey(file: Path) -> BehaviorSurvey:
        read.append(file.name)
        return survey_behavior(file)

    monkeypatch.setattr(behavior_library, "survey_behavior", survey)
    async with _session(project) as session:
        listed = [view.id for view in session.behaviors()]
        assert [view.id for view in session.documents.referable()] == listed
        assert sorted(read) == ["endless.yaml", "quick.yaml"]


async def test_behaviors_are_listed_with_their_problems_and_cells_are_not(project: Path) -> None:
    """What cannot be read is listed with its error."""
    async with _session(project) as session:
        listed = {view.id: view.errors for view in session.behaviors()}
    assert listed == {"behaviors/broken.yaml": 1, "behaviors/endless.yaml": 0, "behaviors/quick.yaml": 0}


async def test_a_changed_file_is_read_anew(project: Path) -> None:
    """No restart is needed after editing."""
    async with _session(project) as session:
        session.behaviors()
        file = project / "behaviors" / "quick.yaml"
        file.write_text(file.read_text(encoding="utf-8").replace("name: quick", "name: quicker"), encoding="utf-8")
        assert session.behavior("behaviors/quick.yaml").name == "quicker"


async def test_a_run_is_reported_from_start_to_end_and_journaled(project: Path) -> None:
    """Events by number, result in the summary, and a row in the journal."""
    async with _session(project) as session:
        run = await session.start("behaviors/quick.yaml", parameters={"pause": 0.02}, seed=1)
        told: list[str] = []
        unsubscribe = session.subscribe(lambda live, change: told.append(live.run_id))
        view = await session.wait(run)
        unsubscribe()
        numbers = [event.seq for event in session.events(run, after=2)]
    assert set(told) == {run}
    assert (view.status, view.outcome, view.success) == ("finished", "good", True)
    assert numbers == list(range(3, numbers[-1] + 1))
    assert [record.status for record in list_runs(project / "journal")] == ["finished"]


async def test_the_classes_that_runs_execute_are_known_by_their_modules(project: Path) -> None:
    """States and behaviours of py_trees, until the run has ended."""
    tree = "flexcell: 1\nname: tree\noutcomes: [success, failure]\nsuccess: [success]\n"
    tree += "root: {tree: {behaviour: 'py_trees.behaviours:Running'}}\n"
    (project / "behaviors" / "tree.yaml").write_text(tree, encoding="utf-8")
    async with _session(project) as session:
        assert not session.executes_classes_of({"tests.engine.fake_states", "py_trees.behaviours"})
        for behavior, module in (("endless", "tests.engine.fake_states"), ("tree", "py_trees.behaviours")):
            run = await session.start(f"behaviors/{behavior}.yaml", parameters={}, seed=1)
            assert session.executes_classes_of({module, "other"})
            assert not session.executes_classes_of({"other"})
            await session.stop(run, reason="enough")
            await session.wait(run)
            assert not session.executes_classes_of({module})


async def test_two_runs_at_once_and_one_resource(project: Path) -> None:
    """The second is refused the robot and told which run holds it; the first goes on."""
    async with _session(project) as session:
        first = await session.start("behaviors/endless.yaml", parameters={}, seed=0)
        second = await session.start("behaviors/endless.yaml", parameters={}, seed=0)
        refused = await session.wait(second)
        assert (session.run(first).status, refused.status) == ("running", "errored")
        assert f"left is commanded by run {first} at root/wait" in refused.cause
        await session.stop(first, reason="enough")
        stopped = await session.wait(first)
        assert (stopped.status, "enough" in stopped.cause) == ("stopped", True)


async def test_closing_the_session_stops_what_runs(project: Path) -> None:
    """Nothing is left running."""
    async with _session(project) as session:
        run = await session.start("behaviors/endless.yaml", parameters={}, seed=0)
    assert session.run(run).status == "stopped"


@pytest.mark.parametrize(
    ("behavior", "parameters", "message"),
    [
        ("behaviors/quikc.yaml", {}, "there is no behavior"),
        ("../etc/passwd", {}, "there is no behavior"),
        ("behaviors/broken.yaml", {}, "broken.yaml:2:1"),
        ("behaviors/quick.yaml", {"pause": -1.0}, "below the minimum"),
    ],
)
async def test_what_cannot_start_says_why(
    project: Path, behavior: str, parameters: dict[str, object], message: str
) -> None:
    """Nothing is entered into the journal."""
    async with _session(project) as session:
        with pytest.raises(DocumentError, match=message):
            await session.start(behavior, parameters=parameters, seed=0)
        with pytest.raises(FlexcellError, match="there is no run 'x'"):
            session.run("x")
    assert list_runs(project / "journal") == ()


async def test_breakpoints_are_kept_beside_the_file_and_used_when_asked_for(project: Path) -> None:
    """Without any there is no file; an id that names no behavior is refused."""
    points = (Breakpoint(path="root/wait"),)
    async with _session(project) as session:
        session.keep_breakpoints("behaviors/quick.yaml", points)
        assert session.breakpoints("behaviors/quick.yaml") == points
        run = await session.start("behaviors/quick.yaml", parameters={}, seed=1, breakpoints=True)
        assert session.control(run).view().breakpoints == points
        session.keep_breakpoints("behaviors/quick.yaml", ())
        with pytest.raises(DocumentError, match="there is no behavior"):
            session.keep_breakpoints("behaviors/../other.yaml", points)
    assert not (project / "behaviors" / "quick.breakpoints.yaml").exists()


async def test_a_run_that_cannot_be_journaled_is_refused_with_the_reason_and_has_failed(project: Path) -> None:
    """Its entry is written while the event loop goes on."""
    with Journal.open(project / "journal", busy_timeout_s=0.01) as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=project, catalogue=CATALOGUE, journal=journal) as session,
        ):
            thief = sqlite3.connect(journal.path, isolation_level=None)
            thief.execute("BEGIN IMMEDIATE")
            with pytest.raises(JournalError, match=r"the journal cannot be written: .*locked.*end that program"):
                await session.start("behaviors/endless.yaml", parameters={}, seed=0)
            (run,) = session.runs()
            ended = await session.wait(run.id)
            assert (ended.status, "locked" in ended.cause) == ("errored", True)
            thief.close()


async def test_everything_is_stopped_at_once(project: Path) -> None:
    """All runs end as stopped, for the reason given; runs start again once the stop is released."""
    async with _session(project) as session:
        runs = [await session.start("behaviors/endless.yaml", parameters={}, seed=1)]
        # It waits for long, and commands nothing that the other one does.
        runs.append(await session.start("behaviors/quick.yaml", parameters={"pause": 100.0}, seed=1))
        await session.stop_all(reason="smoke")
        assert [(await session.wait(run)).status for run in runs] == ["stopped", "stopped"]
        with pytest.raises(ControlError, match="the cell is stopped"):
            await session.start("behaviors/quick.yaml", parameters={}, seed=1)
        await session.recovery.release()
        later = await session.start("behaviors/quick.yaml", parameters={}, seed=1)
        assert (await session.wait(later)).outcome == "good"


async def test_a_behavior_whose_module_is_not_allowed_or_broken_hurts_no_list_and_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is imported by looking, and the others start."""
    monkeypatch.setattr(sys, "path", list(sys.path))
    folder = ProjectFolder(tmp_path)
    bad = folder.module("raise SystemExit(3)")
    folder.allow(bad)
    folder.behavior("broken", f"{bad}:Nod")
    folder.behavior("theirs", "this:Zen")
    folder.behavior("good")
    with Journal.open(tmp_path / "journal") as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=tmp_path, catalogue=load_states(tmp_path), journal=journal) as session,
        ):
            codes = {view.name: [finding.code for finding in view.findings] for view in session.behaviors()}
            assert codes == {"broken": ["unknown-state"], "theirs": ["module-not-allowed"], "good": []}
            run_id = await session.start("behaviors/good.yaml", parameters={}, seed=0)
            assert (await session.wait(run_id)).success
            for name in ("broken", "theirs"):
                with pytest.raises(DocumentError):
                    await session.start(f"behaviors/{name}.yaml", parameters={}, seed=0)
    assert not is_imported("this")


async def test_a_behavior_of_another_cell_is_refused_with_the_reason(project: Path) -> None:
    """One that names a robot which is not here; it is listed all the same, with the cell that it is written for."""
    folder = project / "behaviors"
    robots = "world: {kind: mujoco}\nrobots: {left: {model: panda}}\n"
    (folder / "home.yaml").write_text(f"flexcell: 1\ncell: home\n{robots}", encoding="utf-8")
    state = "motion.MoveJoints, with: {robot: left, target: [0, 0, 0, -1, 0, 1, 0]}"
    text = BEHAVIOR.format(name="move", state=state, outcome="reached: good, failed").replace(
        "name: move", "name: move\ncell: home.yaml"
    )
    (folder / "move.yaml").write_text(text, encoding="utf-8")
    with Journal.open(project / ".flexcell") as journal:
        async with (
            OpenCell(load_cell(folder / "cell.yaml")) as cell,
            Session(cell, project=project, catalogue=load_states(), journal=journal) as session,
        ):
            with pytest.raises(ControlError, match=r"written for the cell home, and c is connected: .*left"):
                await session.start("behaviors/move.yaml", parameters={}, seed=0)
            listed = {each.id: each.fit.cell for each in session.behaviors()}
    assert listed["behaviors/move.yaml"] == "home"
