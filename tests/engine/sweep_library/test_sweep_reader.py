"""The sweeps of a project folder as a page shows them: found, read, written, executed and repeated."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from engine.document import load_cell
from engine.document.sweep import Factor, SweepDocument, load_sweep
from engine.errors import ControlError, DocumentError, FlexcellError
from engine.sweep import SweepResults, SweepSubject, Trials, configurations
from engine.sweep_library.sweep_files import NoSuchSweep
from engine.sweep_library.sweep_reader import SweepReader, require_simulated
from engine.sweep_library.sweep_requests import (
    CreateSweep,
    ListSweeps,
    OfferFactors,
    ReadRuns,
    ReadSweep,
    ReadTrial,
    RecordTrial,
)
from engine.sweep_library.sweep_view import SweepLive
from tests.engine.sweep.luck_project import LuckProject
from tests.engine.sweep_library.saved_sweeps import ID, execute_runs, read, refused

REAL = "flexcell: 1\ncell: real\nrobots: {arm: {model: panda, driver: {kind: other}}}\n"


@pytest.fixture
def project(tmp_path: Path) -> LuckProject:
    """A project with one sweep of ten runs, without results."""
    made = LuckProject(tmp_path)
    made.write(runs=10, require="success >= 0.9", description="Luck", parameters={"otherwise": "raise"})
    return made


def test_sweeps_are_found_with_how_far_they_are(project: LuckProject) -> None:
    execute_runs(project.path, 3)
    (project.path / "sweeps").mkdir()
    (project.path / "sweeps" / "broken.yaml").write_text("flexcell: 1\nbehavior: ../gone.yaml\n")
    (project.path / "other.yaml").write_text("flexcell: 1\nbehavior_note: no sweep\n")
    first, broken = read(project.path, ListSweeps())["sweeps"]
    live = first.pop("live")
    assert first == {
        "id": ID,
        "description": "Luck",
        "behavior": "luck.yaml",
        "design": "random",
        "require": "success >= 0.9",
        "towards": "",
        "factors": ["parameters.luck"],
        "problem": "",
    }
    assert (live["status"], live["planned"], live["done"], live["looked_at"]) == ("idle", 10, 3, 3)
    assert live["interval"][0] <= live["successes"] / 3 <= live["interval"][1]
    assert broken["id"] == "sweeps/broken.yaml"
    assert "gone.yaml" in broken["problem"]


def test_results_that_no_document_asks_for_are_listed_with_their_behavior(project: LuckProject) -> None:
    execute_runs(project.path, 2)
    project.write(runs=10, parameters={"otherwise": "miss"})
    behaviors = project.path / "behaviors"
    behaviors.mkdir(exist_ok=True)
    (behaviors / "luck.yaml").write_bytes(project.behavior.read_bytes())
    (other,) = read(project.path, ListSweeps())["others"]
    assert (other["behavior"], other["runs"]) == ("behaviors/luck.yaml", 2)


def test_a_sweep_is_shown_with_its_summary_and_how_the_interval_narrowed(project: LuckProject) -> None:
    execute_runs(project.path, 10)
    view = read(project.path, ReadSweep(sweep=ID))
    runs = read(project.path, ReadRuns(sweep=ID))
    good = sum(each["success"] for each in runs["runs"])
    assert (view["done"], view["planned"], view["successes"]) == (10, 10, good)
    assert view["document"]["require"] == "success >= 0.9"
    assert [point["runs"] for point in view["curve"]] == list(range(1, 11))
    assert view["curve"][-1]["rate"] == good / 10
    assert view["curve"][-1]["interval"] == view["interval"]
    widths = [high - low for low, high in (point["interval"] for point in view["curve"])]
    assert widths[-1] < widths[0]
    assert {each["name"] for each in view["nodes"]} == {"root", "root/only"}
    assert view["effects"][0]["address"] == "parameters.luck"


def test_failing_runs_come_first_and_are_grouped_by_cause(project: LuckProject) -> None:
    execute_runs(project.path, 10)
    shown = read(project.path, ReadRuns(sweep=ID))
    runs = shown["runs"]
    assert [each["success"] for each in runs] == sorted(each["success"] for each in runs)
    failing = [each["configuration"]["number"] for each in runs if not each["success"]]
    assert 0 < len(failing) < 10
    assert shown["alike"] == [failing]
    assert all(each["nodes"] == {} for each in runs)
    whole = read(project.path, ReadTrial(sweep=ID, number=failing[0]))
    assert whole["nodes"]["root/only"]["visits"] == 1


def test_a_run_without_a_result_is_no_run(project: LuckProject) -> None:
    assert refused(project.path, ReadTrial(sweep=ID, number=3)).kind == "missing"
    assert refused(project.path, ReadTrial(sweep=ID, number=300)).kind == "missing"


@pytest.mark.parametrize(
    "name", ["gone.yaml", "../sweep.yaml", "luck.yaml", "/etc/passwd", "flexcell.yaml", "\0", f"{'a' * 300}.yaml"]
)
def test_only_sweeps_of_the_project_are_read(project: LuckProject, name: str) -> None:
    (project.path.parent / "sweep.yaml").write_bytes(project.text())
    assert refused(project.path, ReadSweep(sweep=name)).kind == "missing"
    assert refused(project.path, OfferFactors(behavior=f"../{name}")).kind == "invalid"


def test_a_run_is_recorded_again_and_compared(project: LuckProject) -> None:
    execute_runs(project.path, 4)
    recorded = read(project.path, RecordTrial(sweep=ID, number=2))
    assert recorded["same"]
    assert recorded["result"]["events_sha256"] == recorded["saved"]["events_sha256"] != ""
    assert (project.path / recorded["recording"]).is_file()


def test_a_run_that_ends_otherwise_is_not_the_same(project: LuckProject) -> None:
    sweep = load_sweep(project.path / ID)
    subject = SweepSubject.load(sweep)
    first = configurations(sweep)[0]
    with SweepResults.open(SweepReader(project.path).results) as results:
        results.describe(subject.hash, subject.versions)
        other = msgspec.structs.replace(Trials(subject).run(first), events_sha256="0" * 64)
        results.save(first.key(subject.hash), subject.hash, other)
    assert not read(project.path, RecordTrial(sweep=ID, number=0))["same"]


def test_a_sweep_with_a_real_robot_is_refused(project: LuckProject) -> None:
    file = project.path / "real.yaml"
    file.write_text(REAL)
    subject = replace(SweepSubject.load(load_sweep(project.path / ID)), cell=load_cell(file))
    with pytest.raises(ControlError, match=r"arm is real \(driver other\): a sweep only simulates"):
        require_simulated(subject)


def test_parameters_are_offered_as_factors(project: LuckProject) -> None:
    luck, rate, otherwise = read(project.path, OfferFactors(behavior="luck.yaml"))
    assert (luck["address"], luck["nominal"], luck["least"], luck["most"]) == ("parameters.luck", 0.0, 0.0, 1.0)
    assert (rate["description"], otherwise["nominal"]) == ("Of success", "miss")


def test_a_new_sweep_is_written_as_short_as_it_can_be(project: LuckProject) -> None:
    document = SweepDocument(
        flexcell=1,
        behavior="luck.yaml",
        factors={"parameters.luck": Factor(uniform=(0.2, 0.8))},
        runs=20,
        require="success >= 0.5",
    )
    assert read(project.path, CreateSweep(sweep="sweeps/new.yaml", document=document)) == "sweeps/new.yaml"
    written = project.path / "sweeps" / "new.yaml"
    assert load_sweep(written).document == msgspec.structs.replace(document, behavior="../luck.yaml")
    assert "placement_noise" not in written.read_text()
    taken = refused(project.path, CreateSweep(sweep="sweeps/new.yaml", document=document))
    assert (taken.kind, taken.words[0]) == ("invalid", "there is a file sweeps/new.yaml already")


@pytest.mark.parametrize("name", ["../out.yaml", "/tmp/out.yaml", "no-suffix", ".hidden/x.yaml", "a/../../b.yaml", ""])
def test_a_new_sweep_stays_in_the_project(project: LuckProject, name: str) -> None:
    document = SweepDocument(flexcell=1, behavior="luck.yaml")
    told = refused(project.path, CreateSweep(sweep=name, document=document))
    assert told.words[0].endswith("is not a name for a sweep")


def test_a_new_sweep_names_no_file_outside(project: LuckProject) -> None:
    document = SweepDocument(flexcell=1, behavior="luck.yaml", store="../secret.db")
    assert "leads out of the project" in refused(project.path, CreateSweep(sweep="a.yaml", document=document)).words[0]


def test_a_new_sweep_that_cannot_be_executed_is_not_written(project: LuckProject) -> None:
    document = SweepDocument(flexcell=1, behavior="luck.yaml", factors={"parameters.lack": Factor(values=(1,))})
    assert "no parameter `lack`" in refused(project.path, CreateSweep(sweep="a.yaml", document=document)).words[0]
    assert not (project.path / "a.yaml").exists()


def test_what_was_loaded_is_loaded_again_once_a_file_has_changed(project: LuckProject) -> None:
    reader = SweepReader(project.path)
    assert reader.list().sweeps[0].live.planned == 10
    project.write(runs=12)
    assert reader.list().sweeps[0].live.planned == 12
    project.behavior.unlink()
    with pytest.raises(DocumentError):
        reader.view(ID)


def test_a_sweep_is_executed_in_the_end(project: LuckProject) -> None:
    shown: list[SweepLive] = []
    project.write(runs=2)
    end = SweepReader(project.path).execute(ID, again=False, show=shown.append)
    assert (end.status, end.done, end.planned) == ("idle", 2, 2)
    assert (shown[0].status, shown[0].done) == ("running", 0)
    with pytest.raises(FlexcellError):
        SweepReader(project.path).execute("gone.yaml", again=False, show=shown.append)
    with pytest.raises(NoSuchSweep):
        SweepReader(project.path).runs("gone.yaml")
