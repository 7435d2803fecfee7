"""Serves the emulators of a cell whose devices with drivers are all of Franka, until it is cancelled."""

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


def has_franka(assigned: Sequence[AssignedDriver]) -> bool:
    """Return whether the devices are of Franka; raises FlexcellError where only some are."""
    kinds = {each.kind for each in assigned}
    if not kinds & _KINDS:
        return False
    if kinds - _KINDS:
        others = ", ".join(sorted(kinds - _KINDS))
        hint = "simulate the others with `driver: sim`, or emulate each alone"
        raise FlexcellError(
            f"a Franka cannot be in one emulated cell with {others}: it brings its own world", hint=hint
        )
    return True


async def serve_franka_cell(
    assigned: Sequence[AssignedDriver], scene: SimScene, options: CellEmulatorOptions, ready: Ready
) -> None:
    """Serve until this is cancelled.

    Raises:
        FlexcellError: a hand is at another address than its arm, franky-sim is not installed, or cannot listen.
    """
    hosts = dict(_arm_hosts(assigned))
    for each in assigned:
        own = each.options(each.driver())
        if isinstance(own, FrankaHandOptions) and hosts.get(each.robot) != own.host:
            raise FlexcellError(f"the hand of {each.robot} is at {own.host}, its arm is not", where=each.written_name)
    cell = FrankaCell(hosts, scene)
    side = SideChannel(cell.execute, host=options.host, port=options.side_port)
    try:
        places = await cell.open()
        ready({"host": options.host, "side_port": await side.open(), "devices": places})
        await asyncio.Event().wait()
    finally:
        side.close()
        await cell.close()


def _arm_hosts(assigned: Sequence[AssignedDriver]) -> list[tuple[str, str]]:
    """Return the addresses of the cabinets, by arm."""
    options = [(each.robot, each.options(each.driver())) for each in assigned]
    return [(robot, own.host) for robot, own in options if isinstance(own, FrankaOptions)]
