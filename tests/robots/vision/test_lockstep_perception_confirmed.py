"""Up to when every camera has shown what is there: pauses, a map that begins anew, and cameras that see nothing."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.skills.simulated_world import CameraFault, SetCameraFault
from robots.vision.lockstep_perception import LockstepPerception
from robots.vision.perception_device import PROCESSING_S
from tests.robots.vision.cell_document import watched
from tests.robots.vision.test_lockstep_perception_occupancy import cameras_of

SLOWEST_S = 0.2
REGULAR_S = SLOWEST_S + PROCESSING_S + 1e-6


def _ages(
    folder: Path, interrupt: Callable[[OpenCell, LockstepPerception], Awaitable[None]], *looks_s: float
) -> tuple[float, ...]:
    """Return the age after a second, and so long after an interruption that was then."""

    async def main() -> tuple[float, ...]:
        async with OpenCell(watched(folder)) as cell:
            cameras = cameras_of(cell)
            assert math.isinf(cameras.confirmed_age_s)
            cameras.require()
            await asyncio.sleep(1.0)
            ages = [cameras.confirmed_age_s]
            await interrupt(cell, cameras)
            for look_s in looks_s:
                await asyncio.sleep(look_s)
                ages.append(cameras.confirmed_age_s)
            return tuple(ages)

    return run_virtual(main())


async def _pause(_cell: OpenCell, cameras: LockstepPerception) -> None:
    cameras.release()
    await asyncio.sleep(3.0)
    cameras.require()


async def _forget(_cell: OpenCell, cameras: LockstepPerception) -> None:
    cameras.forget()


async def _restore(cell: OpenCell, _cameras: LockstepPerception) -> None:
    snapshot = await cell.snapshot()
    assert snapshot is not None
    await cell.restore(snapshot)


async def _cover(cell: OpenCell, _cameras: LockstepPerception) -> None:
    await cell.bus.call(SetCameraFault(camera="side", fault=CameraFault(kind="covered")), to="cell")


def test_after_a_pause_each_camera_must_look_twice(tmp_path: Path) -> None:
    before_s, once_s, twice_s = _ages(tmp_path, _pause, 0.29, 0.2)
    assert before_s <= REGULAR_S
    assert once_s > 2.5
    assert twice_s <= REGULAR_S


@pytest.mark.parametrize("interrupt", [_forget, _restore])
def test_a_map_that_begins_anew_confirms_nothing_of_before(
    tmp_path: Path, interrupt: Callable[[OpenCell, LockstepPerception], Awaitable[None]]
) -> None:
    before_s, once_s, twice_s = _ages(tmp_path, interrupt, 0.29, 0.2)
    assert before_s <= REGULAR_S
    assert math.isinf(once_s)
    assert twice_s <= REGULAR_S


def test_a_covered_camera_shows_nothing(tmp_path: Path) -> None:
    _, later_s = _ages(tmp_path, _cover, 2.0)
    assert later_s > 1.5
