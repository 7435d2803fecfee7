"""Serves the Franka devices of a cell: alone, until it is cancelled, or beside the world of the others."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

from engine.cell.drivers import AssignedDriver, Ready
from engine.errors import FlexcellError
from robots.drivers.cell_emulation.cell_emulator import CellEmulatorOptions
from robots.drivers.emulation.side_channel import SideChannel
from robots.drivers.franka.emulation.franka_cell import FrankaCell
from robots.drivers.franka.franka_options import FrankaOptions
from robots.drivers.franka_hand.franka_hand_options import FrankaHandOptions
from robots.scene.sim_scene import SimScene

_KINDS = frozenset({"franka", "franka_hand"})


def is_franka(assigned: AssignedDriver) -> bool:
    """Return whether a device is an arm or a hand of Franka."""
    return assigned.kind in _KINDS


async def serve_franka_cell(
    assigned: Sequence[AssignedDriver], scene: SimScene, options: CellEmulatorOptions, ready: Ready
) -> None:
    """Serve until this is cancelled.

    Raises:
        FlexcellError: a hand is at another address than its arm, franky-sim is not installed, or cannot listen.
    """
    cell = FrankaCell(franka_hosts(assigned), scene)
    side = SideChannel(cell.execute, host=options.host, port=options.side_port)
    try:
        places = await cell.open()
        ready({"host": options.host, "side_port": await side.open(), "devices": places})
        await asyncio.Event().wait()
    finally:
        side.close()
        await cell.close()


def franka_hosts(assigned: Sequence[AssignedDriver]) -> dict[str, str]:
    """Return the addresses of the cabinets, by arm; raises FlexcellError for a hand at another address than its arm."""
    options = [(each, each.options(each.driver())) for each in assigned if is_franka(each)]
    hosts = {each.robot: own.host for each, own in options if isinstance(own, FrankaOptions)}
    for each, own in options:
        if isinstance(own, FrankaHandOptions) and hosts.get(each.robot) != own.host:
            raise FlexcellError(f"the hand of {each.robot} is at {own.host}, its arm is not", where=each.written_name)
    return hosts
