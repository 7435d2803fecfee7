"""A cell document names an arm with the driver: it reads, moves once a person says so, and again after a loss."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.bus import GoalStatus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.errors import RobotError
from engine.skills.devices import EnableDevice
from engine.skills.digital_outputs import SetOutput
from robots.drivers.arm.driven_arm import DrivenArm
from tests.robots.drivers.abb.emulated_irc5 import ARM, emulated
from tests.robots.drivers.abb.faulty_arm_motion import goal

CELL = """
flexcell: 1
cell: abb
robots:
  arm:
    model: irb4600
    driver:
      kind: abb_irc5
      host: {host}
      motion_port: {motion_port}
      state_port: {state_port}
      gripper: {{port: {gripper_port}, reply: any, reply_s: 5.0}}
      stale_s: 2.0
      timeout_s: 2.0
"""


def test_an_arm_of_a_cell_moves_when_a_person_permits_it_and_again_after_a_lost_connection(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A loaded machine may keep the event loop waiting; what happens then is tested elsewhere.
    monkeypatch.setattr("robots.drivers.arm.arm_setup.ENGINE_SILENCE_S", 5.0)

    async def scenario() -> None:
        with emulated(gripper_reply="ok") as emulator:
            file = tmp_path / "cell.yaml"
            file.write_text(CELL.format(**emulator.place), encoding="utf-8")
            async with OpenCell(load_cell(file), store_path=str(tmp_path / "store.db")) as cell:
                bus = cell.bus
                (arm,) = (device for device in cell.devices if isinstance(device, DrivenArm))
                refused = await bus.send_goal(goal(0.2), to=ARM).result()
                assert refused.status is not GoalStatus.SUCCEEDED
                assert (await bus.call(EnableDevice(reason="a test"), to=ARM)).enabled
                assert (await bus.send_goal(goal(0.2, speed=0.3), to=ARM).result()).status is GoalStatus.SUCCEEDED
                assert emulator.axes[0] == pytest.approx(0.2, abs=1e-6)
                assert (await bus.call(SetOutput(output=0, value=True), to=ARM)).success
                emulator.do("cut")
                while not arm.lost_reason:
                    await bus.clock.sleep(0.05)
                emulator.do("restore")
                while await _lost(arm):
                    await bus.clock.sleep(0.05)
                refused = await bus.send_goal(goal(0.0), to=ARM).result()
                assert refused.status is not GoalStatus.SUCCEEDED
                assert (await bus.call(EnableDevice(reason="it answers again"), to=ARM)).enabled
                assert (await bus.send_goal(goal(0.0, speed=0.3), to=ARM).result()).status is GoalStatus.SUCCEEDED

    asyncio.run(scenario())


async def _lost(arm: DrivenArm) -> bool:
    """Return whether the connection cannot be accepted yet."""
    try:
        await arm.reconnect()
    except RobotError:
        return True
    return False
