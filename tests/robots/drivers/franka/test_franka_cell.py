"""A cell of two FR3 with their hands: each device has its own name, address and robot."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path
from typing import Any

import pytest

from engine.bus import GoalStatus
from engine.cell.open_cell import OpenCell
from engine.document import load_cell
from engine.messages.device_state import DeviceState
from engine.skill import Action
from engine.skills.gripper import GripperMove
from engine.skills.motion import JointTrapVel
from robots.drivers.franka_hand.hand_protocol import HAND_PORT
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.franka.emulated_cabinet import (
    FR3_NEAR,
    FR3_START,
    PATIENT_OPTIONS,
    emulated_cabinet,
    needs_franka,
)

pytestmark = needs_franka
CELL = """\
flexcell: 1
cell: bench
robots:
  left:
    model: fr3
    driver: {left}
    gripper: {{model: panda_hand, driver: {left_hand}}}
  right:
    model: fr3
    base: {{xyz: [0.0, 2.0, 0.0]}}
    driver: {right}
    gripper: {{model: panda_hand, driver: {right_hand}}}
"""
ARMS = ("left", "right")


def write_cell(folder: Path, hosts: dict[str, str]) -> Path:
    """Write a cell with an arm and a hand at each address."""
    drivers: dict[str, str] = {}
    for name, host in hosts.items():
        drivers[name] = json.dumps({"kind": "franka", "host": host, **PATIENT_OPTIONS})
        hand = {"kind": "franka_hand", "host": host, "stale_s": 5.0, "timeout_s": 2.0}
        drivers[f"{name}_hand"] = json.dumps(hand)
    (folder / "cell.yaml").write_text(CELL.format(**drivers), encoding="utf-8")
    return folder / "cell.yaml"


async def true_states(cabinets: dict[str, EmulatedProcess]) -> dict[str, dict[str, Any]]:
    """Return what both robots really do, without blocking the event loop."""
    return {name: await asyncio.to_thread(cabinet.do, "state") for name, cabinet in cabinets.items()}


async def succeeds(cell: OpenCell, goal: Action[Any, Any], to: str) -> None:
    """Send a goal and require its success."""
    end = await cell.bus.send_goal(goal, to=to).result()
    assert (end.status, end.cause) == (GoalStatus.SUCCEEDED, None)


async def test_two_arms_and_two_hands_are_moved_each_by_its_own_name(tmp_path: Path) -> None:
    with emulated_cabinet() as left, emulated_cabinet() as right:
        cabinets = {"left": left, "right": right}
        hosts = {name: str(cabinet.place["host"]) for name, cabinet in cabinets.items()}
        async with OpenCell(load_cell(write_cell(tmp_path, hosts))) as cell:
            addresses: dict[str, str] = {}
            for device in (*ARMS, *(f"{name}/gripper" for name in ARMS)):
                state = cell.bus.topic(f"{device}/device", DeviceState).latest
                assert state is not None
                assert not state.enabled or device.endswith("/gripper")
                addresses[device] = state.address
            assert addresses == {
                **hosts,
                **{f"{name}/gripper": f"{host}:{HAND_PORT}" for name, host in hosts.items()},
            }

            await cell.enable("the bench is clear")
            before = await true_states(cabinets)
            await succeeds(cell, JointTrapVel(joints=tuple(FR3_NEAR.tolist()), speed=0.5), "left")
            await succeeds(cell, GripperMove(width_m=0.03, speed_m_s=0.1), "right/gripper")
            after = await true_states(cabinets)
            assert after["left"]["q"] == pytest.approx(FR3_NEAR.tolist(), abs=0.05)
            assert after["right"]["q"] == pytest.approx(FR3_START.tolist(), abs=0.05)
            assert after["right"]["width_m"] == pytest.approx(0.03, abs=0.003)
            assert after["left"]["width_m"] == pytest.approx(before["left"]["width_m"], abs=0.003)

            # A fault of one robot is none of the other.
            await asyncio.to_thread(left.do, "user_stop")
            stopped = cell.bus.topic("left/device", DeviceState)
            while stopped.latest is None or not stopped.latest.problem.startswith("user stop"):
                await cell.bus.clock.sleep(0.02)
            await succeeds(cell, JointTrapVel(joints=tuple(FR3_NEAR.tolist()), speed=0.5), "right")
            end = await cell.bus.send_goal(
                JointTrapVel(joints=tuple(FR3_START.tolist()), speed=0.5), to="left"
            ).result()
            assert "user stop" in str(end.cause)
