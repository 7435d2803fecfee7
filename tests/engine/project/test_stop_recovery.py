"""The way back after a stop: what is open at each arm, which steps are refused, and the release."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.errors import ControlError, FlexcellError, RobotError
from engine.journal import Journal
from engine.project.cell_stop import CellStop, StoppedDevice
from engine.project.session import Session
from engine.store import Joints, SqliteStore
from tests.engine.fake_states import CATALOGUE
from tests.engine.project.holding_arm import HOME, HoldingArm, put_into
from tests.engine.project.test_session_stops import ENDLESS


@asynccontextmanager
async def opened(project: Path, *, home: str = "home") -> AsyncGenerator[tuple[Session, HoldingArm]]:
    """A session with that arm, which knows where its home is."""
    (project / "behaviors").mkdir()
    (project / "behaviors" / "endless.yaml").write_text(ENDLESS, encoding="utf-8")
    with Journal.open(project / "journal") as journal:
        async with (
            SqliteStore.open(project / "cell.db") as store,
            OpenCell(None) as cell,
            Session(cell, project=project, catalogue=CATALOGUE, journal=journal) as session,
        ):
            if home:
                await store.put("joints", home, Joints(joints=HOME), by="test")
            cell.store = store
            yield session, put_into(cell)


async def _state(session: Session) -> CellStop:
    stop = await session.recovery.state()
    assert stop is not None
    return stop


async def _start(session: Session) -> str:
    return await session.start("behaviors/endless.yaml", parameters={}, seed=0)


async def _stopped(session: Session) -> CellStop:
    await session.stop_all(reason="a look inside")
    return await _state(session)


async def test_a_stop_tells_what_it_did_and_what_is_open(tmp_path: Path) -> None:
    async with opened(tmp_path) as (session, _):
        run = await _start(session)
        await session.control(run).settled()
        stop = await _stopped(session)
        assert (stop.number, stop.phase, stop.reason, stop.parts) == (1, "stopped", "a look inside", "open")
        assert [(each.name, each.status, each.reason) for each in stop.devices] == [("left", "at_rest", "")]
        assert [(each.id, each.path) for each in stop.runs] == [(run, "root/wait")]
        (arm,) = stop.arms
        assert (arm.part, arm.kept, arm.can_release, arm.has_moved) == ("cube", False, True, False)
        assert (arm.home, arm.at_home) == ("home", False)


async def test_no_run_starts_before_the_release_and_runs_can_go_on_after_it(tmp_path: Path) -> None:
    """The stopped runs stay known until one is continued or they are left ended."""
    async with opened(tmp_path) as (session, _):
        run = await _start(session)
        await session.control(run).settled()
        stop = await _stopped(session)
        with pytest.raises(ControlError, match="the cell is stopped") as refused:
            await _start(session)
        assert refused.value.hint == "follow its recovery guide and release the stop"
        session.recovery.close()
        assert (await _state(session)).phase == "stopped"
        with pytest.raises(ControlError, match="stopped again"):
            await session.recovery.release(stop.number + 1)
        await session.recovery.release(stop.number)
        assert (await _state(session)).phase == "released"
        await _start(session)
        assert await session.recovery.state() is None


async def test_a_device_that_is_not_at_rest_keeps_the_stop_until_a_stop_confirms_it(tmp_path: Path) -> None:
    async with opened(tmp_path) as (session, arm):
        arm.fault = "joint 2 still moves"
        with pytest.raises(RobotError):
            await session.stop_all(reason="smoke")
        (device,) = (await _state(session)).devices
        assert (device.status, device.reason) == ("failed", "joint 2 still moves (look at the arm)")
        with pytest.raises(ControlError, match="left has not confirmed that it is at rest"):
            await session.recovery.release()
        arm.fault = ""
        assert (await _stopped(session)).devices[0].status == "at_rest"
        await session.recovery.release()


async def test_a_held_part_is_kept_and_belongs_to_the_arm(tmp_path: Path) -> None:
    """Another stop during the recovery forgets nothing of it; a new one begins anew."""
    async with opened(tmp_path) as (session, arm):
        await _stopped(session)
        await session.recovery.keep("left")
        assert (await _stopped(session)).arms[0].kept
        assert arm.scene == [("attach", "cube")]
        await session.recovery.release()
        assert not (await _stopped(session)).arms[0].kept


async def test_a_held_part_is_released(tmp_path: Path) -> None:
    async with opened(tmp_path) as (session, arm):
        await _stopped(session)
        await session.recovery.release_part("left")
        (now,) = (await _state(session)).arms
        assert (now.part, now.kept, arm.scene) == ("", False, [("detach", "cube")])
        with pytest.raises(ControlError, match="the arm holds nothing"):
            await session.recovery.keep("left")


async def test_an_arm_goes_home_with_what_it_holds(tmp_path: Path) -> None:
    async with opened(tmp_path, home="left_home") as (session, arm):
        await _stopped(session)
        await session.recovery.go_home("left")
        (now,) = (await _state(session)).arms
        assert (now.home, now.at_home, now.has_moved, arm.scene) == ("left_home", True, True, [("attach", "cube")])


async def test_a_way_home_that_fails_says_why_and_what_to_do(tmp_path: Path) -> None:
    async with opened(tmp_path) as (session, arm):
        await _stopped(session)
        arm.blocked = "the table is in between"
        with pytest.raises(ControlError, match="the table is in between") as failed:
            await session.recovery.go_home("left")
        assert failed.value.hint == "jog the arm clear, then try again"
        (now,) = (await _state(session)).arms
        assert "the table is in between" in now.problem
        arm.blocked = ""
        await session.recovery.go_home("left")
        assert (await _state(session)).arms[0].problem == ""


async def test_a_cell_without_a_home_says_what_is_missing(tmp_path: Path) -> None:
    async with opened(tmp_path, home="") as (session, _):
        await _stopped(session)
        with pytest.raises(ControlError, match="no joints entry left_home or home") as refused:
            await session.recovery.go_home("left")
        assert "save its joints" in str(refused.value.hint)


async def test_parts_are_reset_once_for_each_recovery(tmp_path: Path) -> None:
    async with opened(tmp_path) as (session, _):
        await _stopped(session)
        await session.recovery.reset_parts()
        assert (await _state(session)).parts == "reset"
        await session.recovery.release()
        assert (await _stopped(session)).parts == "open"


async def test_steps_that_move_are_refused_in_a_cell_that_is_not_stopped(tmp_path: Path) -> None:
    async with opened(tmp_path) as (session, _):
        recovery = session.recovery
        for step in (recovery.keep("left"), recovery.release_part("left"), recovery.go_home("left")):
            with pytest.raises(ControlError, match="the cell is not stopped"):
                await step
        with pytest.raises(FlexcellError, match="the cell is not stopped"):
            await recovery.reset_parts()


async def test_a_stop_on_both_paths_at_once_is_one_stop(tmp_path: Path) -> None:
    async with opened(tmp_path) as (session, _):
        await asyncio.gather(session.stop_all(reason="first"), session.stop_all(reason="second"))
        stop = await _state(session)
        assert (stop.number, stop.reason) == (1, "first")
        assert stop.devices == (StoppedDevice(name="left", status="at_rest", after_s=stop.devices[0].after_s),)
