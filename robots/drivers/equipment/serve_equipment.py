"""`flexcell equipment serve`: serves a configuration file until it is ended by a signal."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from pathlib import Path

from robots.drivers.equipment.configuration_file import ConfigurationFile
from robots.drivers.equipment.equipment_server import EquipmentServer


async def serve_equipment(
    file: Path, *, host: str, port: int, ready: Callable[[Mapping[str, object]], None], ended: asyncio.Event
) -> None:
    """Serve until `ended` is set; `ready` receives where. Outputs are at their safe values before and after.

    Raises:
        DocumentError: the file is not valid.
        RobotError: the pins are not reached, or the address is taken.
    """
    async with EquipmentServer(ConfigurationFile(file), host=host, port=port) as server:
        ready({"equipment": server.equipment, "host": host, "port": server.port})
        await ended.wait()
