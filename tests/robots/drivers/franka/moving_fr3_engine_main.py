"""An engine with an FR3 in motion, in a process that a test ends: prints a line of JSON when the arm moves."""

from __future__ import annotations

import asyncio
import json
import sys

from robots.drivers.arm.process_arm_connection import ProcessArmConnection
from tests.robots.drivers.arm_under_test import WIDE
from tests.robots.drivers.franka.emulated_cabinet import FR3_FAR, FR3_MODEL, new_fr3_connection
from tests.robots.sim.sim_cell import smooth, until


async def move(connection: ProcessArmConnection) -> None:
    """Start a long motion, report it, and wait for its end."""
    await connection.open()
    await connection.enable()
    port = connection.port
    path = smooth(port.sample().desired_rad, FR3_FAR, 20.0, limits=FR3_MODEL.limits)
    motion = port.follow(path, tolerance=WIDE)
    await until(lambda: motion.progress > 0.1)
    sys.stdout.write(json.dumps({"process": connection.process_id}) + "\n")
    sys.stdout.flush()
    await motion.report()


if __name__ == "__main__":
    asyncio.run(move(new_fr3_connection(sys.argv[1])))
