"""Sweeps over HTTP: listed, made, executed in a process of their own, stopped, and a run of one recorded again."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import httpx
import msgspec
import pytest

from engine.document.sweep import load_sweep
from engine.editing import DocumentRepository
from engine.sweep import SweepResults, SweepSubject, Trials, configurations
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.served import Live, Served
from tests.engine.sweep.luck_project import LuckProject

SWEEP = "/api/v1/sweeps/sweeps/a.yaml"


@pytest.fixture
def project(tmp_path: Path) -> LuckProject:
    """A project with a behavior of luck."""
    folder = tmp_path / "project"
    folder.mkdir()
    return LuckProject(folder)


@asynccontextmanager
async def served_with(serve: Serve, project: LuckProject) -> AsyncGenerator[Served]:
    """A server of the project."""
    async with serve(FakeBackend(documents=DocumentRepository(project.path, {}))) as served:
        yield served


async def progress_of(live: Live) -> dict[str, Any]:
    """The next thing that is told of the sweep; a page answers pings."""
    while True:
        frame = await live.frame()
        if frame["k"] == "ping":
            await live.send({"k": "pong"})
        elif frame["k"] == "sweeps":
            return frame["changed"]["sweeps/a.yaml"]


async def test_a_sweep_is_made_executed_stopped_and_a_failing_run_opened(serve: Serve, project: LuckProject) -> None:
    """What the page does, in one go, because each process takes seconds to start."""
    async with served_with(serve, project) as served:
        http = served.http
        choices = (await http.get("/api/v1/sweep-factors", params={"behavior": "luck.yaml"})).json()
        assert choices[0]["address"] == "parameters.luck"
        document: dict[str, object] = {"flexcell": 1, "behavior": "luck.yaml", "runs": 3000}
        document["factors"] = {"parameters.luck": {"uniform": [0.1, 0.9]}}
        made = await http.post("/api/v1/sweeps", json={"id": "sweeps/a.yaml", "document": document})
        assert (made.status_code, made.json()) == (201, {"id": "sweeps/a.yaml"})
        again = await http.post("/api/v1/sweeps", json={"id": "sweeps/a.yaml", "document": document})
        assert (again.status_code, again.json()["message"]) == (422, "there is a file sweeps/a.yaml already")

        assert (await http.post(f"{SWEEP}/start", json={})).status_code == 202
        other = await http.post(f"{SWEEP}/start", json={})
        assert (other.status_code, other.json()["message"]) == (409, "a sweep is being executed already")
        async with served.live() as live:
            while (now := await progress_of(live))["done"] < 10:
                assert now["status"] == "running"
            assert (await http.post(f"{SWEEP}/stop")).status_code == 202
            while (last := await progress_of(live))["status"] != "idle":
                pass
        assert last["problem"] == ""
        assert 10 <= last["done"] < last["planned"] == 3000
        assert (await http.post(f"{SWEEP}/stop")).status_code == 409

        (line,) = (await http.get("/api/v1/sweeps")).json()["sweeps"]
        assert (line["id"], line["live"]["done"]) == ("sweeps/a.yaml", last["done"])
        view = (await http.get(SWEEP)).json()
        assert (view["done"], view["ended_by"]) == (last["done"], "interrupted")
        failing = (await http.get(f"{SWEEP}/runs")).json()["runs"][0]
        assert not failing["success"]
        number = failing["configuration"]["number"]
        recorded = (await http.post(f"{SWEEP}/runs/{number}/recording")).json()
        assert recorded["same"]
        assert (project.path / recorded["recording"]).is_file()
        assert (await http.get("/api/v1/sweeps/gone.yaml")).status_code == 404

        run = f"{SWEEP}/runs/{number}/shrinking"
        assert (await http.get(run)).json()["status"] == "idle"
        unsaved = await http.post(f"{run}/case", json={"id": "tests/cases/luck.yaml"})
        assert (unsaved.status_code, unsaved.json()["message"]) == (409, "this run was not shrunk")
        assert (await http.post(run, json={"same": "cause"})).status_code == 202
        assert (await http.post(run, json={})).json()["message"] == "a run is being shrunk already"
        # Both are read while it is shrunk: there is nothing to compare with.
        assert (await http.get(f"{SWEEP}/baselines")).json() == []
        unknown = await http.get(f"{SWEEP}/comparison", params={"results": "gone.db", "version": "0"})
        assert unknown.status_code == 404
        while (shrinking := (await http.get(run)).json())["status"] == "running":  # noqa: ASYNC110 - untold
            await asyncio.sleep(0.1)
        assert shrinking["found"]["failing"] == failing["configuration"]
        assert list(shrinking["found"]["shrunk"]["changed"]) == ["parameters.luck"]
        saved = await http.post(f"{run}/case", json={"id": "tests/cases/luck.yaml"})
        assert (saved.status_code, saved.json()) == (201, {"id": "tests/cases/luck.yaml"})
        assert load_sweep(project.path / "tests" / "cases" / "luck.yaml").document.require == "success >= 1"
        assert (await http.get(run)).json()["saved_as"] == "tests/cases/luck.yaml"


@pytest.mark.parametrize("address", ["/sweeps", "/sweeps/sweeps/a.yaml"])
async def test_the_page_is_served_at_its_addresses(serve: Serve, address: str) -> None:
    """So that a link to a sweep can be opened in another window."""
    async with serve() as served:
        answer = await served.http.get(address)
        assert (answer.status_code, "<html" in answer.text) == (200, True)


async def test_a_viewer_starts_nothing(serve: Serve, project: LuckProject) -> None:
    async with served_with(serve, project) as served:
        headers = {"Authorization": f"Bearer {served.access.viewer}"}
        async with httpx.AsyncClient(base_url=served.running.url, headers=headers, trust_env=False) as viewer:
            assert (await viewer.post(f"{SWEEP}/start", json={})).status_code == 403
            assert (await viewer.post(f"{SWEEP}/runs/0/recording")).status_code == 403
            assert (await viewer.post(f"{SWEEP}/runs/0/shrinking", json={})).status_code == 403
            assert (await viewer.post(f"{SWEEP}/runs/0/shrinking/case", json={"id": "a.yaml"})).status_code == 403


async def test_a_process_that_dies_is_named(serve: Serve, project: LuckProject) -> None:
    """The execution of a run again in a process that ends: the page learns how."""
    project.write(parameters={"otherwise": "exit", "rate": 0.0}, runs=1)
    sweep = load_sweep(project.path / "sweep.yaml")
    subject = SweepSubject.load(sweep)
    first = configurations(sweep)[0]
    with SweepResults.open(project.path / ".flexcell" / "sweeps.db") as results:
        results.describe(subject.hash, subject.versions)
        lucky = load_sweep(project.path / "sweep.yaml")
        result = Trials(SweepSubject.load(project.sweep(runs=1))).run(configurations(lucky)[0])
        results.save(first.key(subject.hash), subject.hash, msgspec.structs.replace(result, configuration=first))
    async with served_with(serve, project) as served:
        refused = await served.http.post("/api/v1/sweeps/sweep.yaml/runs/0/recording")
        assert refused.json()["message"] == "the sweep process ended with exit code 7"
