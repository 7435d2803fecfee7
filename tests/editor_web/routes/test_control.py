"""Operating runs over HTTP and the websocket: the real server around a real session."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest

from editor_web.security.authentication import VIEWER, load_access_tokens
from editor_web.server import dashboard
from engine.cell.open_cell import OpenCell
from engine.event import Event, GateReached, NodeEntered, OperatorChanged, RunSteppedBack, UserdataWritten
from engine.journal import Journal
from engine.project.session import Session
from engine.registry import load_states
from engine.runtime.history.live_run import LiveRun, LiveRunChange
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.limits import GUARD_S
from tests.editor_web.served import Served
from tests.engine.cli.process import entered, run_id_in, started, until

STEPS = """
flexcell: 1
name: steps
userdata: {value: 0}
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: one
    states:
      one: {state: flow.SetValue, with: {value: 1}, transitions: {done: two}}
      two: {state: flow.Wait, with: {duration_s: 0.01}, autonomy: {done: high}, transitions: {done: three}}
      three: {state: flow.SetValue, with: {value: 2}, transitions: {done: good}}
"""
ASKS = """
flexcell: 1
name: asks
outcomes: [good]
success: [good]
root:
  machine:
    initial: only
    states:
      only: {state: flow.Wait, with: {duration_s: 3000}, resume: ask, transitions: {done: good}}
"""
STEPS_ID = "behaviors/steps.yaml"


@dataclass(frozen=True, kw_only=True)
class Site:
    """A served session with its project."""

    session: Session
    served: Served
    project: Path

    async def start(self, **body: object) -> str:
        """Start the behavior over HTTP."""
        answer = await self.served.http.post("/api/v1/runs", json={"behavior": STEPS_ID, **body})
        assert answer.status_code == 201, answer.text
        return answer.json()["run"]

    async def command(self, run: str, command: str, **body: object) -> httpx.Response:
        """Send one command."""
        return await self.served.http.post(f"/api/v1/runs/{run}/control/{command}", json=body)

    async def recorded(self, run: str, kind: type[Event], count: int = 1) -> None:
        """Wait until a run has had so many events of a kind."""
        enough = asyncio.Event()

        def look(live: LiveRun, change: LiveRunChange) -> None:
            if sum(isinstance(known, kind) for known in self.session.events(run)) >= count:
                enough.set()

        unsubscribe = self.session.subscribe(look)
        if sum(isinstance(known, kind) for known in self.session.events(run)) < count:
            await enough.wait()
        unsubscribe()


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with both behaviors."""
    (tmp_path / "behaviors").mkdir()
    (tmp_path / STEPS_ID).write_text(STEPS, encoding="utf-8")
    (tmp_path / "behaviors" / "asks.yaml").write_text(ASKS, encoding="utf-8")
    return tmp_path


@asynccontextmanager
async def site(project: Path, host: str) -> AsyncGenerator[Site]:
    """Serve a session without a cell."""
    tokens = project / "tokens"
    with Journal.open(project / ".flexcell") as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=project, catalogue=load_states(), journal=journal) as session,
            dashboard(session, token_file=tokens, host=host, cell_view=False, shadows=False) as running,
        ):
            access = load_access_tokens(tokens)
            headers = {"Authorization": f"Bearer {access.operator}"}
            async with httpx.AsyncClient(
                base_url=running.url, headers=headers, trust_env=False, timeout=GUARD_S
            ) as http:
                served = Served(backend=FakeBackend(), running=running, access=access, http=http)
                yield Site(session=session, served=served, project=project)


async def test_a_paused_run_is_stepped_and_resumed(project: Path, loopback: str) -> None:
    async with site(project, loopback) as there:
        run = await there.start(supervision={"start_paused": True})
        await there.recorded(run, GateReached)
        seen: dict[str, Any] = (await there.served.http.get(f"/api/v1/runs/{run}/control")).json()
        assert (seen["paused"], seen["confirmed"], seen["operator"]) == (True, True, "none")
        assert [(each["path"], each["point"], each["reasons"]) for each in seen["waiting"]] == [
            ("root", "before", ["pause"])
        ]
        stepped = await there.command(run, "step", mode="into")
        assert stepped.status_code == 200
        # What the step has led to, not where the run was when it was commanded.
        assert [each["path"] for each in stepped.json()["waiting"]] == ["root/one"]
        assert not (await there.command(run, "resume")).json()["paused"]
        assert (await there.session.wait(run)).outcome == "good"


async def test_a_paused_run_is_stepped_back_until_nothing_is_left(project: Path, loopback: str) -> None:
    async with site(project, loopback) as there:
        run = await there.start(supervision={"start_paused": True})
        await there.recorded(run, GateReached)
        for waiting in ("root/one", "root/two"):
            assert [each["path"] for each in (await there.command(run, "step")).json()["waiting"]] == [waiting]
        back = await there.command(run, "step_back")
        assert back.status_code == 200
        assert [(each["path"], each["point"]) for each in back.json()["waiting"]] == [("root/one", "before")]
        await there.recorded(run, RunSteppedBack)
        book = there.session.userdata(run)
        book.read(there.session.events(run))
        assert {key: entry.value for key, entry in book.scopes[""].values.items()} == {"value": 0}
        refused = await there.command(run, "step_back", path="root/one")
        assert (refused.status_code, refused.json()["message"]) == (409, "the run is at its beginning")
        await there.command(run, "resume")
        assert (await there.session.wait(run)).outcome == "good"
        over = await there.command(run, "step_back")
        assert over.status_code == 409


async def test_a_value_of_a_paused_run_is_replaced(project: Path, loopback: str) -> None:
    """As the engine does it; what cannot be set is refused with where and why."""
    async with site(project, loopback) as here:
        run = await here.start(supervision={"start_paused": True})
        set_to = {"key": "value", "value": {"mm": [1.5, None]}}
        answer = await here.command(run, "userdata", **set_to)
        assert answer.status_code == 200, answer.text
        written = [each for each in here.session.events(run) if isinstance(each, UserdataWritten)]
        assert [(each.scope, each.key, each.value) for each in written] == [("", "value", {"mm": [1.5, None]})]
        large = {"key": "value", "value": list(range(5000))}
        await here.command(run, "userdata", **large)
        whole = await here.served.http.get(f"/api/v1/runs/{run}/control/userdata", params={"key": "value"})
        assert whole.json() == {"scope": "", **large}
        unknown = await here.command(run, "userdata", key="valeu", value=1)
        assert (unknown.status_code, unknown.json()["message"]) == (422, "there is no userdata key 'valeu'")
        assert "value" in unknown.json()["hint"]
        assert (await here.command(run, "userdata", key="value")).status_code == 422
        await here.command(run, "resume")
        assert (await here.command(run, "userdata", **set_to)).status_code == 409


async def test_locks_breakpoints_orders_and_autonomy(project: Path, loopback: str) -> None:
    async with site(project, loopback) as there:
        run = await there.start(supervision={"start_paused": True, "demand_operator": True, "autonomy": "low"})
        locked = await there.command(run, "lock", path="root/one", reason="the tray is being changed")
        assert locked.json()["locks"] == ["root/one"]
        points = [{"path": "root/three", "if": "value == 1"}]
        answered = (await there.command(run, "breakpoints", breakpoints=points)).json()["breakpoints"]
        assert answered == points
        await there.command(run, "resume")
        await there.recorded(run, GateReached, 2)
        assert (await there.command(run, "unlock", path="root/one")).json()["locks"] == []
        await there.recorded(run, GateReached, 3)
        seen = (await there.served.http.get(f"/api/v1/runs/{run}/control")).json()
        assert [(each["outcome"], each["required"]) for each in seen["waiting"]] == [("done", "high")]
        assert (seen["demanded"], seen["loss_policy"], seen["loss_timeout_s"]) == (True, "hold", 5.0)
        assert (await there.command(run, "repeat", path="root/two")).status_code == 200
        await there.recorded(run, GateReached, 4)
        assert (await there.command(run, "answer", path="root/two")).status_code == 200
        await there.recorded(run, GateReached, 5)
        assert (await there.command(run, "autonomy", level="full")).json()["autonomy"] == "full"
        assert (await there.command(run, "force", path="root/three", outcome="done")).status_code == 200
        await there.command(run, "resume")
        assert (await there.session.wait(run)).outcome == "good"


async def test_what_the_run_does_not_allow_now_is_409_and_what_is_not_there_404(project: Path, loopback: str) -> None:
    async with site(project, loopback) as there:
        run = await there.start(supervision={"start_paused": True})
        for command, body, message in (
            ("force", {"path": "root/three", "outcome": "done"}, "this node is not active"),
            ("force", {"path": "root/tow", "outcome": "done"}, "there is no such node"),
            ("unlock", {"path": "root/one"}, "this node is not locked"),
            ("answer", {"path": "root/two"}, "this node has requested no outcome"),
        ):
            answer = await there.command(run, command, **body)
            assert (answer.status_code, answer.json()["message"]) == (409, message)
        assert (await there.command(run, "autonomy", level="much")).status_code == 422
        wrong = await there.command(run, "breakpoints", breakpoints=[{"path": "root", "if": "1 +"}])
        assert (wrong.status_code, "Syntax error" in wrong.json()["message"]) == (422, True)
        assert (await there.command("nobody", "pause")).status_code == 404
        assert (await there.served.http.get("/api/v1/runs/nobody/control")).status_code == 404
        await there.command(run, "resume")
        await there.session.wait(run)
        over = await there.command(run, "pause")
        assert (over.status_code, over.json()["message"]) == (409, "this run is over")


async def test_a_viewer_may_look_and_not_touch(project: Path, loopback: str) -> None:
    async with site(project, loopback) as there:
        run = await there.start(supervision={"start_paused": True})
        headers = {"Authorization": f"Bearer {there.served.access.viewer}"}
        url = there.served.running.url
        async with httpx.AsyncClient(base_url=url, headers=headers, trust_env=False, timeout=GUARD_S) as viewer:
            assert (await viewer.get(f"/api/v1/runs/{run}/control")).status_code == 200
            assert (await viewer.post(f"/api/v1/runs/{run}/control/resume")).status_code == 403
            assert (await viewer.get(f"/api/v1/breakpoints/{STEPS_ID}")).status_code == 200
            assert (await viewer.put(f"/api/v1/breakpoints/{STEPS_ID}", json={"breakpoints": []})).status_code == 403
            assert (await viewer.post("/api/v1/cell/stop", json={})).status_code == 403
        assert VIEWER == "viewer"


async def test_the_file_as_it_is_now_takes_over(project: Path, loopback: str) -> None:
    async with site(project, loopback) as there:
        run = await there.start(supervision={"start_paused": True})
        (project / STEPS_ID).write_text(STEPS.replace("value: 2", "value: 3"), encoding="utf-8")
        answer = await there.served.http.post(f"/api/v1/runs/{run}/control/change")
        assert (answer.status_code, answer.json()) == (200, {"changes": ["root/three has changed parameters"]})
        await there.command(run, "resume")
        await there.session.wait(run)
        again = await there.served.http.post(f"/api/v1/runs/{run}/control/change")
        assert again.status_code == 409


async def test_what_runs_is_given_up_for_the_file_only_where_that_is_said(project: Path, loopback: str) -> None:
    async with site(project, loopback) as there:
        answer = await there.served.http.post("/api/v1/runs", json={"behavior": "behaviors/asks.yaml"})
        run = answer.json()["run"]
        await there.recorded(run, NodeEntered, 2)
        await there.command(run, "pause")
        other = ASKS.replace("flow.Wait, with: {duration_s: 3000}", "flow.Log, with: {message: hi}")
        (project / "behaviors" / "asks.yaml").write_text(other, encoding="utf-8")
        refused = await there.command(run, "change")
        assert refused.status_code == 409
        assert "root/only is active as flow.Wait and becomes flow.Log" in refused.json()["message"]
        assert "`preempt`" in refused.json()["hint"]
        taken = await there.command(run, "change", preempt=True)
        assert taken.json()["changes"][-1] == "root/only is preempted and entered anew"
        await there.command(run, "resume")
        assert (await there.session.wait(run)).outcome == "good"


async def test_a_page_operates_a_run_until_it_says_so_or_is_gone(project: Path, loopback: str) -> None:
    """Asked while somebody is there; the connection that breaks is an operator lost."""
    async with site(project, loopback) as there:
        supervision = {"autonomy": "low", "start_paused": True, "loss_policy": "continue", "loss_timeout_s": 0.0}
        run = await there.start(supervision=supervision)
        async with there.served.live(run) as page:
            await page.send({"k": "operate", "run": run})
            await there.recorded(run, OperatorChanged)
            await page.send({"k": "operate", "run": ""})
            await there.recorded(run, OperatorChanged, 2)
            await page.send({"k": "operate", "run": run})
            await there.recorded(run, OperatorChanged, 3)
            await there.command(run, "resume")
            await there.recorded(run, GateReached, 2)
        assert (await there.session.wait(run)).outcome == "good"
        changes = [event.status for event in there.session.events(run) if isinstance(event, OperatorChanged)]
        assert changes == ["attached", "detached", "attached", "lost"]


async def test_an_interrupted_run_is_listed_asked_about_and_resumed(project: Path, loopback: str) -> None:
    with started("run", project / "behaviors" / "asks.yaml", "-q", cwd=project) as process:
        until(process, project, entered("root/only"))
    run = run_id_in(project)
    async with site(project, loopback) as there:
        http = there.served.http
        listed = (await http.get("/api/v1/interrupted")).json()
        assert [(each["id"], each["behavior"]) for each in listed] == [(run, "asks")]
        asked = await http.post(f"/api/v1/interrupted/{run}/resume", json={})
        assert asked.status_code == 409
        assert "root/only (rerun, done)" in asked.json()["message"]
        assert asked.json()["questions"] == [{"path": "root/only", "outcomes": ["done"]}]
        answer = await http.post(f"/api/v1/interrupted/{run}/resume", json={"answers": {"root/only": "done"}})
        assert (answer.status_code, answer.json()) == (201, {"run": run})
        assert (await there.session.wait(run)).outcome == "good"
        assert (await http.get("/api/v1/interrupted")).json() == []
        events = (await http.get(f"/api/v1/runs/{run}/events")).json()["events"]
        assert [event["event"] for event in events][-1] == "run_ended"
        assert "resumed" in [event["event"] for event in events]


async def test_a_run_begins_at_a_moment_of_another(project: Path, loopback: str) -> None:
    async with site(project, loopback) as there:
        before = await there.start()
        await there.session.wait(before)
        last = there.session.events(before)[-1].seq
        run = await there.start(begin={"run": before, "seq": last, "path": "root/three"})
        assert (await there.session.wait(run)).outcome == "good"
        answer = await there.served.http.post(
            "/api/v1/runs", json={"behavior": STEPS_ID, "begin": {"run": before, "seq": 900}}
        )
        assert (answer.status_code, "has no event 900" in answer.json()["message"]) == (422, True)


async def test_breakpoints_are_kept_beside_the_file_for_later_runs(project: Path, loopback: str) -> None:
    """In the same file as those of the command line; what does not compile leaves it as it was."""
    address = f"/api/v1/breakpoints/{STEPS_ID}"
    points = [{"path": "root/two", "when": "after", "if": "value == 1", "hits": 2, "outcomes": ["done"]}]
    async with site(project, loopback) as there:
        http = there.served.http
        assert (await http.get(address)).json() == {"breakpoints": []}
        kept = (await http.put(address, json={"breakpoints": points})).json()
        assert kept == {"breakpoints": points}
        wrong = await http.put(address, json={"breakpoints": [{"path": "root", "if": "1 +"}]})
        assert wrong.status_code == 422
        assert (await http.get(address)).json() == kept
        assert "root/two" in (project / "behaviors" / "steps.breakpoints.yaml").read_text(encoding="utf-8")
        asked = {"path": "root/two", "if": "valu == 1", "when": "before"}
        checked = (await http.post(f"{address}/condition", json=asked)).json()
        assert checked["names"] == ["value"]
        assert checked["problem"] == "`valu` is not defined before `two`"
        for nowhere in ("behaviors/none.yaml", "../steps.yaml", "%2e%2e/steps.yaml"):
            refused = await http.put(f"/api/v1/breakpoints/{nowhere}", json={"breakpoints": []})
            assert refused.status_code in (404, 422)
        await http.put(address, json={"breakpoints": []})
        assert not (project / "behaviors" / "steps.breakpoints.yaml").exists()


async def test_the_live_stream_carries_the_control_of_the_watched_run(project: Path, loopback: str) -> None:
    """With reasons of locks, questions with what they require, and nothing once the run is over."""
    async with site(project, loopback) as there:
        run = await there.start(supervision={"start_paused": True, "demand_operator": True, "autonomy": "low"})
        await there.recorded(run, GateReached)
        await there.command(run, "lock", path="root/one", reason="look first")
        async with there.served.live(run) as page:
            frame = await page.until("snapshot", run=run)
            assert frame["control"]["paused"]
            assert frame["control"]["locks"] == ["root/one"]
            assert frame["lock_reasons"] == {"root/one": "look first"}
            assert [each["waits"] for each in frame["runs"]] == ["paused"]
            await there.command(run, "unlock", path="root/one")
            await there.command(run, "resume")
            while not any("autonomy" in each["reasons"] for each in frame["control"]["waiting"]):
                frame = await page.until("delta", run=run)
            asking = frame["control"]["waiting"][0]
            assert (asking["path"], asking["outcome"], asking["required"]) == ("root/two", "done", "high")
            await there.command(run, "answer", path="root/two")
            while frame["control"] is not None:
                frame = await page.until("delta", run=run)
        assert (await there.session.wait(run)).outcome == "good"


async def test_the_cell_is_stopped_with_all_its_runs(project: Path, loopback: str) -> None:
    async with site(project, loopback) as there:
        runs = [await there.start(supervision={"start_paused": True}) for _ in range(2)]
        answer = await there.served.http.post("/api/v1/cell/stop", json={"reason": "smoke"})
        assert answer.status_code == 204
        for run in runs:
            assert (await there.session.wait(run)).status == "stopped"
