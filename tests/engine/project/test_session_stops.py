"""STOP of a session, through the event loop and past it: runs end, devices latch until they have ended."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.document import load_cell
from engine.errors import ControlError
from engine.journal import Journal
from engine.project.cell_reopening import CellReopening
from engine.project.session import Session
from engine.stop import StopRelay
from tests.engine.fake_states import CATALOGUE
from tests.engine.stop.device import Device, device, endpoint_of, post

ENDLESS = """
flexcell: 1
name: endless
outcomes: [good]
success: [good]
root:
  machine:
    initial: wait
    states:
      wait: {state: test.Use, with: {for_s: 1000}, transitions: {done: good}}
"""

TIDY = """
flexcell: 1
name: tidy
outcomes: [good]
success: [good]
root:
  machine:
    initial: wait
    states:
      wait: {state: test.Hang, with: {cleanup_s: 0.2}, transitions: {never: good}}
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "behaviors").mkdir()
    (tmp_path / "behaviors" / "endless.yaml").write_text(ENDLESS, encoding="utf-8")
    (tmp_path / "behaviors" / "tidy.yaml").write_text(TIDY, encoding="utf-8")
    return tmp_path


@dataclass(kw_only=True)
class _Opened:
    session: Session
    relay: StopRelay
    arm: Device

    async def start(self, name: str = "endless") -> str:
        return await self.session.start(f"behaviors/{name}.yaml", parameters={}, seed=0)


@asynccontextmanager
async def opened_session(project: Path) -> AsyncGenerator[_Opened]:
    with Journal.open(project / "journal") as journal:
        async with (
            StopRelay(host="127.0.0.1") as relay,
            OpenCell(None, relay=relay) as cell,
            device(relay) as arm,
            Session(cell, project=project, catalogue=CATALOGUE, journal=journal) as session,
        ):
            yield _Opened(session=session, relay=relay, arm=arm)


async def test_a_stop_that_came_while_the_loop_was_blocked_ends_the_run_and_then_releases(project: Path) -> None:
    async with opened_session(project) as opened:
        run = await opened.start()
        endpoint = endpoint_of(opened.relay)
        asking = threading.Thread(target=post, args=(endpoint,), kwargs={"reason": "the door is open"})
        asking.start()
        # Nothing of the session runs until the stop has been answered.
        asking.join()
        assert opened.arm.line.latched
        stopped = await opened.session.wait(run)
        await asyncio.to_thread(opened.arm.released.wait)
    assert (stopped.status, "the door is open" in stopped.cause) == ("stopped", True)


async def test_a_stop_through_the_loop_latches_the_devices_too(project: Path) -> None:
    async with opened_session(project) as opened:
        run = await opened.start()
        await opened.session.stop_all(reason="end of shift")
        await asyncio.to_thread(opened.arm.stopped.wait)
        assert opened.arm.stops == ["end of shift"]
        stopped = await opened.session.wait(run)
        await asyncio.to_thread(opened.arm.released.wait)
    assert (stopped.status, "end of shift" in stopped.cause) == ("stopped", True)


async def test_a_relay_that_is_gone_ends_the_runs_and_hinders_no_stop(project: Path) -> None:
    async with opened_session(project) as opened:
        run = await opened.start()
        opened.relay.kill()
        stopped = await opened.session.wait(run)
        await opened.session.stop_all(reason="again")
        await asyncio.to_thread(opened.arm.stopped.wait)
        assert opened.arm.line.cut
    assert (stopped.status, "the stop relay has ended" in stopped.cause) == ("stopped", True)


async def test_a_release_during_a_stop_takes_effect_after_it(project: Path) -> None:
    async with opened_session(project) as opened:
        stopped = await opened.start("tidy")
        await opened.session.stop_all(reason="a look inside")
        assert opened.session.run(stopped).status != "stopped", "its clean-up takes longer than the stop of the robots"
        await opened.session.recovery.release()
        assert opened.session.run(stopped).status == "stopped"
        await opened.start()
        await asyncio.to_thread(opened.arm.released.wait)


async def test_a_cell_that_is_stopped_is_not_opened_anew_without_its_stop(project: Path) -> None:
    """The stop ends with the cell, and simulated arms of the next one would move at once."""
    file = project / "cell.yaml"
    file.write_text(
        "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nrobots: {left: {model: ur10, driver: {kind: vendor_arm}}}\n",
        encoding="utf-8",
    )
    reopening = CellReopening(load_cell(file))
    with Journal.open(project / "journal") as journal:
        async with (
            OpenCell(None) as cell,
            Session(cell, project=project, catalogue=CATALOGUE, journal=journal, reopening=reopening) as session,
        ):
            following = asyncio.create_task(reopening.requested())
            await asyncio.sleep(0)
            await session.stop_all(reason="a look inside")
            with pytest.raises(ControlError, match="the cell is stopped"):
                await reopening.request(("left",))
            assert not following.done()
            await session.recovery.release()
            await reopening.request(("left",))
            assert set((await following).simulated) == {"left"}
