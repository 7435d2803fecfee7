"""Who watches the workspace learns of every change, also after an error of the measurements or of another watcher."""

from __future__ import annotations

import asyncio
import logging

import pytest

from engine.errors import RobotError
from robots.port import ArmSample
from robots.workspace.workspace import LOOK_S
from tests.robots.workspace.fake_cell import FakeCell, fake_cell

LOST = "the world is lost"
pytestmark = pytest.mark.virtual


def _move(cell: FakeCell) -> None:
    cell.port.lead_to(tuple((cell.port.sample().position_rad + 0.1).tolist()))


@pytest.mark.parametrize("error", [RobotError(LOST), ValueError(LOST)], ids=["of the robot", "unexpected"])
async def test_measurements_that_fail_make_watchers_look_and_go_on_afterwards(
    error: Exception, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def lost() -> ArmSample:
        raise error

    heard: list[frozenset[str]] = []
    async with fake_cell() as cell:
        unwatch = cell.workspace.watch(heard.append)
        await asyncio.sleep(2.5 * LOOK_S)
        with monkeypatch.context() as patch:
            patch.setattr(cell.port, "sample", lost)
            await asyncio.sleep(3.0 * LOOK_S)
            assert heard == [frozenset()] * 3
        heard.clear()
        _move(cell)
        await asyncio.sleep(1.5 * LOOK_S)
        assert heard == [frozenset({"left"})]
        unwatch()
    assert [record.getMessage() for record in caplog.records if LOST in record.getMessage()] == [
        f"the scene is not measured: {LOST}"
    ]


async def test_a_watcher_that_fails_keeps_nothing_from_the_others(caplog: pytest.LogCaptureFixture) -> None:
    def fail(_names: frozenset[str]) -> None:
        raise ValueError("odd")

    heard: list[frozenset[str]] = []
    async with fake_cell() as cell:
        unwatch = (cell.workspace.watch(fail), cell.workspace.watch(heard.append))
        await asyncio.sleep(1.5 * LOOK_S)
        for _ in range(2):
            _move(cell)
            await asyncio.sleep(LOOK_S)
        assert heard == [frozenset({"left"})] * 2
        for end in unwatch:
            end()
    failures = [record for record in caplog.records if record.levelno == logging.ERROR]
    assert len(failures) == 2


async def test_who_no_longer_watches_hears_nothing() -> None:
    heard: list[frozenset[str]] = []
    async with fake_cell() as cell:
        unwatch = cell.workspace.watch(heard.append)
        unwatch()
        _move(cell)
        await asyncio.sleep(3.0 * LOOK_S)
        assert heard == []
