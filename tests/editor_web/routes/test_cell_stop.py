"""The stop of the cell over HTTP and in the live stream: what it did, the steps after it, and who may do them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import httpx
import pytest

from editor_web.live.hub import LiveClient, LiveHub
from editor_web.live.live_frames import CellStopChanged, LiveSnapshot
from tests.editor_web.limits import GUARD_S
from tests.editor_web.routes.test_control import STEPS, STEPS_ID, Site, site
from tests.engine.project.holding_arm import put_into

AFTER = ("release", "close", "reset_parts", "arms/left/keep", "arms/left/release_part", "arms/left/home")


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with one behavior."""
    (tmp_path / "behaviors").mkdir()
    (tmp_path / STEPS_ID).write_text(STEPS, encoding="utf-8")
    return tmp_path


async def _post(there: Site, step: str) -> httpx.Response:
    return await there.served.http.post(f"/api/v1/cell/stop{step}", json={})


async def test_a_stop_is_shown_taken_step_by_step_and_released(project: Path, loopback: str) -> None:
    async with site(project, loopback) as there:
        arm = put_into(there.session.cell)
        http = there.served.http
        assert (await http.get("/api/v1/cell/stop")).json() is None
        run = await there.start(supervision={"start_paused": True})
        assert (await _post(there, "")).status_code == 204
        stop = (await http.get("/api/v1/cell/stop")).json()
        assert (stop["phase"], stop["arms"][0]["part"], [each["id"] for each in stop["runs"]]) == (
            "stopped",
            "cube",
            [run],
        )
        refused = await http.post("/api/v1/runs", json={"behavior": stop["runs"][0]["behavior"]})
        assert (refused.status_code, refused.json()["message"]) == (409, "the cell is stopped")
        assert (await _post(there, "/arms/left/keep")).status_code == 204
        home = await _post(there, "/arms/left/home")
        assert (home.status_code, "no joints entry left_home" in home.json()["message"]) == (409, True)
        assert (await _post(there, "/arms/left/release_part")).status_code == 204
        assert (await _post(there, "/reset_parts")).status_code == 204
        assert arm.part == ""
        assert (await http.post("/api/v1/cell/stop/release", json={"stop": 7})).status_code == 409
        assert (await _post(there, "/release")).status_code == 204
        assert (await http.get("/api/v1/cell/stop")).json()["phase"] == "released"
        assert (await _post(there, "/close")).status_code == 204
        assert (await http.get("/api/v1/cell/stop")).json() is None


@pytest.mark.parametrize("step", AFTER)
async def test_a_viewer_does_no_step(project: Path, loopback: str, step: str) -> None:
    async with site(project, loopback) as there:
        headers = {"Authorization": f"Bearer {there.served.access.viewer}"}
        url = there.served.running.url
        async with httpx.AsyncClient(base_url=url, headers=headers, trust_env=False, timeout=GUARD_S) as viewer:
            assert (await viewer.get("/api/v1/cell/stop")).status_code == 200
            assert (await viewer.post(f"/api/v1/cell/stop/{step}", json={})).status_code == 403


async def test_every_page_sees_a_stop_and_what_changes_at_the_arms(project: Path, loopback: str) -> None:
    """A page that comes later has it in its snapshot; nothing is looked at any more once the stop is closed."""
    async with site(project, loopback) as there:
        arm = put_into(there.session.cell)
        hub = LiveHub(there.session)
        hub.open()
        try:
            client = hub.join()
            assert isinstance(client.frame(), LiveSnapshot)
            await there.session.stop_all(reason="smoke")
            await _until(client, lambda frame: frame.stop is not None and frame.stop.phase == "stopped")
            arm.part = ""
            await _until(client, lambda frame: frame.stop is not None and frame.stop.arms[0].part == "")
            later = hub.join().frame()
            assert isinstance(later, LiveSnapshot)
            assert later.stop == hub.stop_watch.stop
            await there.session.recovery.release()
            there.session.recovery.close()
            await _until(client, lambda frame: frame.stop is None)
        finally:
            hub.close()
            await hub.stop_watch.close()


async def _until(client: LiveClient, condition: Callable[[CellStopChanged], bool]) -> None:
    """Read frames until one about the stop is as it should be."""
    while True:
        await client.dirty.wait()
        frame = client.frame()
        if isinstance(frame, CellStopChanged) and condition(frame):
            return
