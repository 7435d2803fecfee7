"""Starting, stopping and reading runs over HTTP."""

from __future__ import annotations

import asyncio

import httpx

from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_behaviors import SINGLE, TRANSFER
from tests.editor_web.limits import GUARD_S


async def ended(http: httpx.AsyncClient, run: str) -> dict[str, object]:
    """Wait for the end of a run."""
    async with asyncio.timeout(GUARD_S):
        while True:
            body = (await http.get(f"/api/v1/runs/{run}")).json()
            if body["status"] not in ("running", "stopping"):
                return body
            await asyncio.sleep(0.01)


async def test_a_run_is_started_and_its_events_can_be_read(serve: Serve) -> None:
    """From the form to the journal."""
    async with serve() as served:
        answer = await served.http.post("/api/v1/runs", json={"behavior": TRANSFER.id, "parameters": {"speed": 0.3}})
        assert answer.status_code == 201
        run = answer.json()["run"]
        body = await ended(served.http, run)
        assert (body["status"], body["outcome"], body["success"]) == ("finished", "finished", True)
        page = (await served.http.get(f"/api/v1/runs/{run}/events", params={"limit": 3})).json()
        assert [event["event"] for event in page["events"]] == ["run_started", "entered", "entered"]
        assert page["events"][0]["parameters"] == {"speed": 0.3}
        rest = (await served.http.get(f"/api/v1/runs/{run}/events", params={"after": page["last"]})).json()
        assert rest["events"][0]["seq"] == 4
        assert rest["events"][-1]["event"] == "run_ended"


async def test_a_repeated_request_starts_one_run(serve: Serve) -> None:
    """A double click, or an answer that was lost."""
    async with serve() as served:
        first, second = [
            await served.http.post(
                "/api/v1/runs", json={"behavior": TRANSFER.id}, headers={"Idempotency-Key": "double-click"}
            )
            for _ in range(2)
        ]
        assert (first.status_code, second.status_code) == (201, 200)
        assert first.json() == second.json()
        assert len((await served.http.get("/api/v1/runs")).json()) == 1


async def test_a_refused_parameter_is_named_for_the_form(serve: Serve) -> None:
    """`where` is the field."""
    async with serve() as served:
        answer = await served.http.post("/api/v1/runs", json={"behavior": SINGLE.id, "parameters": {}})
        assert answer.status_code == 422
        assert answer.json() == {"message": "a value is required", "where": "part", "hint": "name a stored entry"}


async def test_a_malformed_request_says_where(serve: Serve) -> None:
    """Unknown keys, seeds out of range, no behavior."""
    async with serve() as served:
        bodies: dict[str, dict[str, object]] = {
            "speed": {"behavior": TRANSFER.id, "speed": 1},
            "seed": {"behavior": TRANSFER.id, "seed": -1},
            "behavior": {},
        }
        for where, body in bodies.items():
            answer = await served.http.post("/api/v1/runs", json=body)
            assert (answer.status_code, answer.json()["where"]) == (422, where)


async def test_a_run_can_be_stopped(serve: Serve) -> None:
    """It answers at once; the run ends as stopped, with the reason among its events."""
    async with serve(FakeBackend(step_s=5.0)) as served:
        run = (await served.http.post("/api/v1/runs", json={"behavior": TRANSFER.id})).json()["run"]
        answer = await served.http.post(f"/api/v1/runs/{run}/stop", json={"reason": "lunch"})
        assert answer.status_code == 202
        assert (await ended(served.http, run))["status"] == "stopped"
        events = (await served.http.get(f"/api/v1/runs/{run}/events")).json()["events"]
        assert "lunch" in [event.get("reason") for event in events]


async def test_an_unknown_run_is_not_found(serve: Serve) -> None:
    """Reading 404, stopping 422 with the engine's words."""
    async with serve() as served:
        assert (await served.http.get("/api/v1/runs/none")).status_code == 404
        assert (await served.http.get("/api/v1/runs/none/events")).status_code == 404
        answer = await served.http.post("/api/v1/runs/none/stop", json={})
        assert (answer.status_code, answer.json()["message"]) == (422, "no run 'none'")
