"""Collision-free motion in real time: planners in processes of their own, which may be killed in mid-motion."""

from __future__ import annotations

import asyncio
import os
import re
import signal
from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus
from robots.planning.worker.planning_worker import PlanningWorker
from robots.workspace.planning_services import PlanningServices
from tests.robots.workspace.free_cell import ACROSS, POST, REST_RAD_S, THERE, free, free_cell


@pytest.mark.timeout(300)
async def test_killed_planning_processes_stop_the_arm_and_new_ones_take_it_to_its_goal(tmp_path: Path) -> None:
    """One story, because the processes take seconds to start."""
    workers: list[PlanningWorker] = []

    def make(_clock: object) -> PlanningWorker:
        workers.append(PlanningWorker())
        return workers[-1]

    async with free_cell(tmp_path, arms=("left",)) as opened:
        opened.workspace.planners = PlanningServices(opened.bus.clock, make)
        await opened.go(THERE)
        assert (len(workers), all(worker.pid for worker in workers)) == (2, True)
        # So slow that it is still far from there when the post comes into its way, however late that is.
        handle = opened.send(free(ACROSS, speed=0.2))
        await opened.until(lambda: opened.speed_rad_s() > 2.0 * REST_RAD_S, within_s=30.0)
        killed = [worker.pid for worker in workers]
        for pid in killed:
            os.kill(pid, signal.SIGKILL)
        await opened.put(POST)
        async with asyncio.timeout(240.0):
            end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops >= 1) == (GoalStatus.SUCCEEDED, True)
        assert np.abs(opened.joints() - ACROSS).max() < 0.01
        # Who was asked just then ended with the process; who asks later waits in vain for the next one to start.
        assert any(re.search("SIGKILL|was not checked", message.reason) for message in opened.told)
        assert all(worker.pid not in (0, *killed) for worker in workers)
    assert [worker.pid for worker in workers] == [0, 0]
