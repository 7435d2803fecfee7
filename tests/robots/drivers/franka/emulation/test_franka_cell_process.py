"""The process of the cabinets of a cell: it keeps parts where another world has them, and its end has a cause."""

from __future__ import annotations

import asyncio
import os
import signal

import pytest

from engine.errors import CellError
from engine.messages import Pose
from robots.drivers.franka.emulation.franka_cell_process import FrankaCellProcess
from robots.drivers.franka.emulation.simulator_messages import SimulatorReport
from robots.scene.sim_scene import ArmPlacement, SimScene
from tests.robots.drivers.franka.emulated_cabinet import needs_franka
from tests.robots.own_address import own_address
from tests.robots.sim.sim_cell import TABLE, box

pytestmark = needs_franka
ARM = ArmPlacement(name="arm", model="fr3", base=Pose(xyz=(-0.55, 0.0, 0.0)), gripper="panda_hand")
SCENE = SimScene(arms=(ARM,), fixtures=(TABLE,), parts=(box("cube"),))


async def test_parts_are_where_another_world_keeps_them_and_a_lost_process_is_named() -> None:
    franka = FrankaCellProcess({"arm": own_address()}, SCENE)
    reports: asyncio.Queue[SimulatorReport] = asyncio.Queue()
    try:
        places = await franka.open()
        assert places["arm"]["arm"] == 1337
        reading = asyncio.create_task(franka.read(reports.put_nowait))

        async def height_m(above_m: float, below_m: float) -> None:
            while not above_m < (await reports.get()).parts["cube"].xyz[2] < below_m:
                pass

        franka.keep({"cube": Pose(xyz=(0.2, 0.0, 0.5))})
        await height_m(0.4999, 0.5001)
        franka.keep({"cube": None})
        await height_m(0.0, 0.03)
        os.kill(franka.process_id, signal.SIGKILL)
        with pytest.raises(CellError, match="the cabinets have ended with -9"):
            await reading
    finally:
        await franka.close()
