"""An emulated cell ends with its world, and does not begin where another program listens."""

from __future__ import annotations

import asyncio
import socket
from pathlib import Path
from typing import Any

import pytest

from engine.errors import CellError, FlexcellError
from robots.drivers.cell_emulation.cell_emulator import CELL_EMULATOR, CellEmulatorOptions
from robots.drivers.cell_emulation.serve_cell import serve_cell
from robots.drivers.franka.emulation.control_cabinet import inner_address
from robots.drivers.franka.emulation.simulated_robot import RobotSimulator
from robots.drivers.franka.emulation.simulator_messages import RobotSetup, SimulatorSetup
from robots.sim.world.sim_world import SimWorld
from tests.robots.drivers.franka.emulated_cabinet import needs_franka
from tests.robots.own_address import own_address

CELL = """flexcell: 1
cell: emulated
world: {{kind: mujoco}}
robots:
  arm: {{model: ur10, driver: {{kind: universal_robots, host: {host}, client: script}}}}
"""


class WorldBroken(Exception):
    """What the simulation raises."""


def test_a_cell_whose_world_cannot_be_stepped_ends_with_the_cause_and_waits_for_no_motion(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(CELL.format(host=own_address()))
    ready: list[object] = []
    step = SimWorld.advance

    def broken(world: SimWorld, until_s: float) -> float:
        # The emulated controller has the arm of the world follow a stream from its first cycle on.
        if ready and world.arm("arm").sample().time_s > 0.1:
            host: Any = world.host
            monkeypatch.setattr(host.simulation, "step", failing)
        return step(world, until_s)

    def failing() -> None:
        raise WorldBroken("a body has left the world")

    monkeypatch.setattr(SimWorld, "advance", broken)
    with pytest.raises(BaseExceptionGroup) as ended:
        asyncio.run(serve_cell(CellEmulatorOptions(file=str(file)), ready.append))
    assert ready
    assert ended.group_contains(WorldBroken, match="a body has left the world")


@pytest.mark.parametrize(
    ("device", "port", "who"),
    [
        (
            "ur10, driver: {kind: universal_robots, host: HOST, client: script}",
            30004,
            "arm: the emulator universal_robots",
        ),
        ("irb4600, driver: {kind: abb_irc5, host: HOST, gripper: {port: 11004}}", 11004, "arm: the emulator abb_irc5"),
        ('servo_arm, driver: {kind: servo_arm, device: "socket://HOST:5002"}', 5002, "arm: the emulator servo_arm"),
        pytest.param("fr3, driver: {kind: franka, host: HOST}", 1338, "the emulator cell", marks=needs_franka),
    ],
)
def test_an_address_that_is_taken_is_named_with_the_device_and_what_to_do(
    tmp_path: Path, device: str, port: int, who: str
) -> None:
    host = own_address()
    file = tmp_path / "cell.yaml"
    device = device.replace("HOST", host)
    file.write_text(f"flexcell: 1\ncell: emulated\nworld: {{kind: mujoco}}\nrobots:\n  arm: {{model: {device}}}\n")
    with socket.create_server((host, port)), pytest.raises(FlexcellError) as refused:
        asyncio.run(CELL_EMULATOR.run(CellEmulatorOptions(file=str(file)), unexpected))
    said = str(refused.value)
    assert said.startswith(f"{who} cannot listen at {host}:{port}: address already in use (")
    assert "choose another host" in said


@needs_franka
def test_an_address_that_is_taken_is_named_beside_other_makes_too(tmp_path: Path) -> None:
    """The cabinets are in a process of their own there."""
    host, file = own_address(), tmp_path / "cell.yaml"
    other = f"  other: {{model: fr3, base: {{xyz: [0.0, 2.0, 0.0]}}, driver: {{kind: franka, host: {host}}}}}\n"
    file.write_text(CELL.format(host=host) + other)
    with socket.create_server((host, 1338)), pytest.raises(FlexcellError) as refused:
        asyncio.run(CELL_EMULATOR.run(CellEmulatorOptions(file=str(file)), unexpected))
    said = str(refused.value)
    assert said.startswith(f"the emulator cell cannot listen at {host}:1338: address already in use (")


@needs_franka
def test_a_simulated_robot_whose_address_is_taken_is_named() -> None:
    inner = inner_address(own_address())
    simulator = RobotSimulator(SimulatorSetup(robots=(RobotSetup(host=inner),)))
    with (
        socket.create_server((inner, 1337)),
        pytest.raises(CellError, match=rf"franky-sim cannot listen at {inner}:1337: Address already in use \(.*host"),
    ):
        asyncio.run(simulator.start())


def unexpected(place: object) -> None:
    raise AssertionError(f"it listens at {place}")
