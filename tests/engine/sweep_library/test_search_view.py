"""A search for failures of a project as a page shows it: in the words and with the figure of its report."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from engine.document.sweep import Factor, SearchSpec, SweepDocument, load_sweep
from engine.sweep_library.sweep_reader import SweepReader
from engine.sweep_library.sweep_requests import (
    CompareSweep,
    CreateSweep,
    FindBaselines,
    ListSweeps,
    ReadRuns,
    ReadSweep,
    ReadTrial,
)
from engine.sweep_library.sweep_view import SweepLive
from tests.engine.sweep.luck_project import LuckProject
from tests.engine.sweep_library.saved_sweeps import ID, execute_batches, read, refused


@pytest.fixture
def project(tmp_path: Path) -> LuckProject:
    """A project with a search of two batches of eight runs, without results."""
    made = LuckProject(tmp_path)
    made.write(
        search={"towards": "most duration_s", "runs": 16, "batch": 8},
        parameters={"otherwise": "raise", "rate": 0.8},
        require="success >= 0.9",
    )
    return made


def test_a_search_is_listed_with_what_it_has_found(project: LuckProject) -> None:
    execute_batches(project.path, 1)
    (line,) = read(project.path, ListSweeps())["sweeps"]
    live = line["live"]
    assert (line["towards"], line["require"], line["problem"]) == ("most duration_s", "", "")
    assert (live["done"], live["planned"], live["interval"], live["verdict"]) == (8, 16, None, None)
    view = read(project.path, ReadSweep(sweep=ID))
    assert live["search"] == {
        "failures": view["failures"],
        "nearest": view["nearest"][0]["duration_s"],
        "is_satisfied": False,
    }


def test_a_search_is_shown_with_the_sentences_and_the_figure_of_its_report(project: LuckProject) -> None:
    execute_batches(project.path, 2)
    view = read(project.path, ReadSweep(sweep=ID))
    runs = read(project.path, ReadRuns(sweep=ID))
    failing = [each["configuration"]["number"] for each in runs["runs"] if not each["success"]]
    assert (view["done"], view["failures"]) == (16, len(failing))
    assert 0 < len(failing) < 16
    assert runs["alike"] == [failing]
    assert view["found"].startswith(f"{len(failing)} of 16 runs failed; the first one is run #{failing[0]}")
    assert view["method"].startswith("Searched by cross-entropy towards most duration_s")
    low, high = view["probability"]["interval"]
    assert low < view["probability"]["estimate"] < high
    assert "effective failures" in view["likelihood"]
    assert [each["batch"] for each in view["batches"]] == [0, 1]
    assert view["clusters"][0]["cause"]["runs"] == len(failing)
    assert view["figure"].count("data-run=") == 16
    assert f'class="bad" data-run="{failing[0]}"' in view["figure"]
    whole = read(project.path, ReadTrial(sweep=ID, number=failing[0]))
    assert whole["nodes"]["root/only"]["visits"] == 1
    assert refused(project.path, ReadTrial(sweep=ID, number=16)).kind == "missing"


def test_a_search_that_has_found_enough_is_satisfied(project: LuckProject) -> None:
    project.write(search={"runs": 16, "batch": 8, "stop_after": 1}, parameters={"rate": 0.0})
    execute_batches(project.path, 1)
    (line,) = read(project.path, ListSweeps())["sweeps"]
    assert (line["live"]["done"], line["live"]["search"]["is_satisfied"]) == (1, True)
    assert line["live"]["search"]["nearest"] is None


def test_a_search_towards_a_number_that_no_run_has_hides_no_other_sweep(project: LuckProject) -> None:
    execute_batches(project.path, 1)
    project.write(
        search={"towards": "most luck", "runs": 16, "batch": 8}, parameters={"otherwise": "raise", "rate": 0.8}
    )
    (project.path / "other.yaml").write_bytes(project.text(runs=3))
    other, wrong = read(project.path, ListSweeps())["sweeps"]
    assert (other["problem"], other["live"]["planned"]) == ("", 3)
    assert "no run has a number `luck`" in wrong["problem"]


def test_a_search_is_executed_batch_by_batch(project: LuckProject) -> None:
    project.write(search={"runs": 4, "batch": 4})
    shown: list[SweepLive] = []
    end = SweepReader(project.path).execute(ID, again=False, show=shown.append)
    assert (end.status, end.done, end.planned) == ("idle", 4, 4)
    assert end.search is not None
    assert (shown[0].status, shown[0].done) == ("running", 0)


def test_a_new_search_is_written(project: LuckProject) -> None:
    factors = {"parameters.luck": Factor(uniform=(0.2, 0.8))}
    document = SweepDocument(flexcell=1, behavior="luck.yaml", factors=factors, search=SearchSpec(stop_after=3))
    read(project.path, CreateSweep(sweep="sweeps/new.yaml", document=document))
    written = load_sweep(project.path / "sweeps" / "new.yaml").document
    assert written == msgspec.structs.replace(document, behavior="../luck.yaml")
    nothing = msgspec.structs.replace(document, factors={})
    assert "nothing to vary" in refused(project.path, CreateSweep(sweep="a.yaml", document=nothing)).words[0]


def test_a_search_has_no_baseline(project: LuckProject) -> None:
    execute_batches(project.path, 1)
    assert read(project.path, FindBaselines(sweep=ID)) == []
    request = CompareSweep(sweep=ID, results=".flexcell/sweeps.db", version="0")
    assert "chosen to fail" in refused(project.path, request).words[0]
