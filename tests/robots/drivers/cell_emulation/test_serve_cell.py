"""An emulated cell ends with its world."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import pytest

from robots.drivers.cell_emulation.cell_emulator import CellEmulatorOptions
from robots.drivers.cell_emulation.serve_cell import serve_cell
from robots.sim.world.sim_world import SimWorld
from tests.robots.drivers.universal_robots.emulated_controller import own_address

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
