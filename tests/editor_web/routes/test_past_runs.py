"""Looking at runs over HTTP: of this server, of its journal after a restart, of recordings; and what is refused."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path
from typing import Any

import httpx
import pytest

from engine.clock import run_virtual
from engine.recording import part_file
from engine.runtime.history.live_run import LiveRun
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_behaviors import TRANSFER
from tests.editor_web.limits import GUARD_S
from tests.editor_web.workshop import SHIFT_ID, Workshop
from tests.engine.archive.test_archive import GOES_WRONG
from tests.engine.replay.rig import record_run

WRONG_ID = "behaviors/wrong.yaml"
RECORDED = """
root:
  machine:
    initial: it
    states:
      it: {state: bench.Work, with: {for_s: 2}, transitions: {a: good, b: bad, c: bad}}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project with a behavior that goes wrong."""
    project = tmp_path_factory.mktemp("past")
    (project / "behaviors").mkdir()
    (project / WRONG_ID).write_text(f"{GOES_WRONG}userdata: {{kept: 7}}\n")
    return project


@pytest.fixture(scope="module")
def restarted(folder: Path, loopback: str) -> Generator[tuple[Workshop, str]]:
    """A server that was restarted after a run, and that run."""
    with Workshop(host=loopback, project=folder) as before:
        run = before.start(WRONG_ID)
        before.call(before.session.wait(run))
    with Workshop(host=loopback, project=folder) as shop:
        yield shop, run


@pytest.fixture
def http(restarted: tuple[Workshop, str]) -> Generator[httpx.Client]:
    """A client with the operator's token."""
    shop, _ = restarted
    with client_of(shop) as client:
        yield client


def client_of(shop: Workshop) -> httpx.Client:
    """The operator of a server."""
    headers = {"Authorization": f"Bearer {shop.access.operator}"}
    return httpx.Client(base_url=f"{shop.running.url}api/v1", headers=headers, trust_env=False, timeout=GUARD_S)


def got(http: httpx.Client, path: str, **query: object) -> Any:
    """The answer to a request that is not refused."""
    answer = http.get(path, params={key: str(value) for key, value in query.items()})
    assert answer.status_code == 200, answer.text
    return answer.json()


async def test_a_run_of_this_server_is_reported_while_it_goes_on(serve: Serve) -> None:
    """What was told is not told again; a moment in the middle is what the live view showed."""
    async with serve() as served:
        run = await served.backend.start(TRANSFER.id, parameters={"part": "part_a"}, seed=1)
        first = (await served.http.get(f"/api/v1/runs/{run}/timeline")).json()
        assert not first["ended"]
        async with served.live(run) as live:
            while not any(line["kind"] == "run_ended" for line in (await live.frame()).get("log", ())):
                pass
        events = served.backend.events(run)
        rest = (await served.http.get(f"/api/v1/runs/{run}/timeline", params={"after": first["seq"]})).json()
        assert rest["ended"]
        assert rest["seq"] == len(events)
        assert all(max(s["seq"], s["end_seq"]) > first["seq"] for row in rest["rows"] for s in row["spans"])
        middle = len(events) // 2
        moment = (await served.http.get(f"/api/v1/runs/{run}/at", params={"seq": middle})).json()
        lived = LiveRun(run)
        for event in events[:middle]:
            lived.apply(event)
        assert {path: node["status"] for path, node in moment["nodes"].items()} == {
            path: node.status for path, node in lived.state.nodes.items()
        }
        assert [line["text"] for line in moment["log"]] == [line.text for line in lived.log]


def test_after_a_restart_a_run_is_found_and_opened(http: httpx.Client, restarted: tuple[Workshop, str]) -> None:
    """With its behavior, its timeline, its end, and how it failed."""
    _, run = restarted
    listed = got(http, "/past-runs")
    assert [each["id"] for each in listed["runs"]] == [run]
    assert (listed["counts"]["failed"], listed["counts"]["finished"]) == (1, 0)
    opened = got(http, f"/runs/{run}/past")
    assert (opened["run"]["failed"], opened["behavior"]["id"]) == (True, WRONG_ID)
    timeline = got(http, f"/runs/{run}/timeline")
    assert [row["path"] for row in timeline["rows"]] == ["root", "root/one"]
    assert {span["status"] for row in timeline["rows"] for span in row["spans"]} == {"failed"}
    assert "failure" in {mark["kind"] for mark in timeline["marks"]}
    end = got(http, f"/runs/{run}/at")
    assert end["nodes"]["root/one"]["status"] == "failed"
    values = got(http, f"/runs/{run}/userdata")
    assert (values["scopes"][""]["values"]["kept"]["value"], values["problem"]) == (7, "")
    watched = got(http, f"/runs/{run}/userdata", watches='[{"expression": "kept > 6"}, {"expression": "kept +"}]')
    assert [(each["value"], each["problem"] == "") for each in watched["watches"]] == [(True, True), (None, False)]
    assert http.get(f"/runs/{run}/userdata", params={"watches": "[{"}).status_code == 422
    failure = got(http, f"/runs/{run}/failure")
    assert (failure["path"], failure["text"]) == ("root/one", "division by zero")


def test_a_moment_that_is_known_is_not_sent_again(http: httpx.Client, restarted: tuple[Workshop, str]) -> None:
    """Scrubbing asks twenty times a second, and mostly nothing has happened in between."""
    _, run = restarted
    seq = got(http, f"/runs/{run}/at", seq=3)["seq"]
    assert http.get(f"/runs/{run}/at", params={"seq": 3, "known": seq}).status_code == 204
    assert len(got(http, f"/runs/{run}/at", seq=3, lines=1)["log"]) == 1


@pytest.mark.parametrize(
    ("query", "found"),
    [
        ({"text": "wrong ZERO"}, 1),
        ({"text": "elsewhere"}, 0),
        ({"kind": "failed"}, 1),
        ({"kind": "finished"}, 0),
        ({"until_s": 1000}, 0),
        ({"since_s": 1000}, 1),
        ({"offset": 1}, 0),
    ],
)
def test_past_runs_are_found(http: httpx.Client, query: dict[str, object], found: int) -> None:
    """By words of their behavior or cause, by how they ended, by when they began."""
    assert len(got(http, "/past-runs", **query)["runs"]) == found


def test_a_recording_is_opened_with_the_behavior_inside_it(
    http: httpx.Client, restarted: tuple[Workshop, str], folder: Path
) -> None:
    """Also one with blanks in its name, and one that was cut off."""
    path = folder / "my runs" / "one.mcap"
    path.parent.mkdir(exist_ok=True)
    run_virtual(record_run(RECORDED, path, rate_hz=50))
    part_file(folder / "my runs" / "two.mcap").write_bytes(path.read_bytes()[:-40])
    names = {file["path"]: file["problem"] for file in got(http, "/recordings")}
    assert names == {"my runs/one.mcap": "", "my runs/two.mcap.part": ""}
    for name in names:
        opened = got(http, f"/recordings/{name}")
        assert [child["name"] for child in opened["behavior"]["graph"]["children"]] == ["it"]
        timeline = got(http, f"/recordings/{name}/timeline")
        assert timeline["duration_s"] == 2.0
        half = got(http, f"/recordings/{name}/at", time_s=1.0)
        assert half["nodes"]["root/it"]["status"] == "active"
        assert got(http, f"/recordings/{name}/failure") is None
    address = "/recordings/my runs/one.mcap"
    (topic,) = got(http, f"{address}/fields")["topics"]
    curves = got(http, f"{address}/curves", field="bench/tick:number", from_s=0, until_s=2, cells=2)
    assert (topic["topic"], curves["times_s"]) == ("bench/tick", [0.25, 0.75, 1.25, 1.75])
    assert curves["columns"][0][0] < curves["columns"][0][3]


@pytest.mark.parametrize(
    "path",
    [
        "/runs/nobody/timeline",
        "/runs/nobody/at",
        "/runs/nobody/past",
        "/runs/nobody/failure",
        "/recordings/nothing.mcap",
        "/recordings/nothing.mcap/at",
        "/runs/nobody/fields",
        "/recordings/nothing.mcap/curves?field=a:b&from_s=0&until_s=1",
        "/recordings/..%2F..%2Fetc%2Fpasswd",
        "/recordings/%2Fetc%2Fpasswd.mcap/timeline",
        "/recordings/behaviors/wrong.yaml",
    ],
)
def test_what_is_not_there_is_said_in_words(http: httpx.Client, path: str) -> None:
    """And nothing outside of the project is there."""
    answer = http.get(path)
    assert answer.status_code == 404
    assert answer.json()["message"].startswith("there is no")


def test_garbage_is_refused_in_words(http: httpx.Client, folder: Path) -> None:
    """It is a recording by its name only."""
    (folder / "garbage.mcap").write_bytes(b"not at all" * 40)
    answer = http.get("/recordings/garbage.mcap")
    (folder / "garbage.mcap").unlink()
    assert answer.status_code == 422
    assert "not an MCAP file" in answer.json()["message"]


@pytest.mark.parametrize(
    "query", ["time_s=nan", "time_s=-1", "seq=x", "seq=99999999999999999999", "lines=5000", "time_s=inf"]
)
def test_a_moment_that_is_none_is_refused(http: httpx.Client, restarted: tuple[Workshop, str], query: str) -> None:
    """Before anything is looked at."""
    _, run = restarted
    assert http.get(f"/runs/{run}/at?{query}").status_code == 422


def test_a_viewer_may_look(restarted: tuple[Workshop, str]) -> None:
    """At everything; and nobody without a token."""
    shop, run = restarted
    for headers, status in (({"Authorization": f"Bearer {shop.access.viewer}"}, 200), ({}, 401)):
        url = f"{shop.running.url}api/v1"
        with httpx.Client(base_url=url, headers=headers, trust_env=False, timeout=GUARD_S) as client:
            for path in ("/past-runs", "/recordings", f"/runs/{run}/timeline", f"/runs/{run}/at", f"/runs/{run}/past"):
                assert client.get(path).status_code == status


def test_a_run_of_this_server_is_followed_by_many_at_once(shop: Workshop) -> None:
    """Each is told the same."""
    run = shop.start(SHIFT_ID)
    try:
        with client_of(shop) as http:
            told = [got(http, f"/runs/{run}/timeline") for _ in range(3)]
        assert len({each["run"] for each in told}) == 1
        assert told[-1]["seq"] >= told[0]["seq"]
    finally:
        shop.call(shop.session.stop(run, reason="enough"))
        shop.call(shop.session.wait(run))


def test_two_runs_are_compared(http: httpx.Client, restarted: tuple[Workshop, str]) -> None:
    """One with itself meets everywhere; without a good one before it, there is nothing to compare it with."""
    _, run = restarted
    same = got(http, "/past-runs/comparison", left=run, right=run)
    assert (same["divergence"], [each["path"] for each in same["visits"]]) == (None, ["root", "root/one"])
    assert same["right"]["id"] == run
    for query in ({"right": run}, {"left": "nowhere", "right": run}, {"left": run, "right": "no/such.mcap"}):
        answer = http.get("/past-runs/comparison", params=query)
        assert answer.status_code == 404, query
        assert answer.json()["message"], query


def test_a_run_without_a_good_one_before_it_has_none(http: httpx.Client, restarted: tuple[Workshop, str]) -> None:
    """Nor has one that the journal does not have."""
    _, run = restarted
    assert [got(http, f"/runs/{each}/last-good-run") for each in (run, "nowhere")] == [None, None]


def test_the_runs_of_a_behavior_have_a_trend(http: httpx.Client) -> None:
    """Of a behavior that always fails, there are no durations."""
    found = got(http, "/past-runs/trend", behavior="goes wrong", last=5)
    assert (found["known"], found["succeeded"], found["failed"], found["duration"]) == (1, 0, 1, None)
    assert got(http, "/past-runs/trend", behavior="of nobody")["known"] == 0
