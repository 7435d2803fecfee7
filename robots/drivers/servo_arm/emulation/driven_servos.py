"""The servos of a plant behind an emulated board: what is written to them, in each of their periods."""

from __future__ import annotations

import numpy as np

from robots.drivers.emulation.plant import Plant
from robots.drivers.servo_arm.emulation.emulated_board import EmulatedBoard

# Servos take a pulse every 20 ms; in between they go on to the last one.
_PERIOD_S = 0.02


async def drive_servos(board: EmulatedBoard, plant: Plant) -> None:
    """Let the servos of a plant follow what the board writes, until this is cancelled; output 0 is the claw.

    A board that has started and was not told to go gives no pulses: its servos stay where they are. A servo reports
    nothing: one that is blocked goes on as soon as it can, and the board does not know of it.
    """
    arm, clock, closes = plant.arm, plant.clock, False
    if arm is None:
        return
    while True:
        board.advance()
        if board.attached:
            if arm.problem:
                arm.reset()
            angles_rad = np.radians(board.written_deg[: board.servos])
            arm.follow(angles_rad, np.zeros(board.servos))
            if board.closes != closes:
                closes = board.closes
                plant.on_output(0, on=closes)
        await clock.sleep_until(clock.now_s() + _PERIOD_S)
