"""An engine with an arm in motion, in a process that a test ends: prints a line of JSON when the arm moves."""

from __future__ import annotations

import asyncio
import json
import sys

from robots.drivers.arm.process_arm_connection import ProcessArmConnection
from tests.robots.drivers.arm_under_test import FAR, MODEL, WIDE, new_connection
from tests.robots.sim.sim_cell import smooth, until


async def move(connection: ProcessArmConnection) -> None:
    """Start a long motion, report it, and wait for its end."""
    await connection.open()
    await connection.enable()
    port = connection.port
    motion = port.follow(smooth(port.sample().desired_rad, FAR, 20.0, limits=MODEL.limits), tolerance=WIDE)
    await until(lambda: motion.progress > 0.1)
    sys.stdout.write(json.dumps({"process": connection.process_id}) + "\n")
    sys.stdout.flush()
    await motion.report()


if __name__ == "__main__":
    asyncio.run(move(new_connection(sys.argv[1], client=sys.argv[2])))
