"""The arm of the key-press example goes where the pressed key says, in physics."""

from __future__ import annotations

import math
from pathlib import Path

from engine.cell.open_cell import OpenCell
from engine.messages.topic_value import TopicValue
from engine.runtime.run import Run
from tests.behaviors.application import Application, shipped_cell

PRESSES = ((1.0, "x"), (2.0, "w"), (14.0, "h"), (26.0, "q"))
OVER_WATER_RAD = (0.6435011, 0.35)
HOME_RAD = (0.0, 0.1745329)


async def press(_run: Run, cell: OpenCell) -> None:
    for at_s, key in PRESSES:
        await cell.bus.clock.sleep(at_s - cell.bus.clock.now_s())
        cell.bus.topic("operator/key", TopicValue).publish(TopicValue(value=key))


def test_the_arm_moves_where_the_pressed_key_says(tmp_path: Path) -> None:
    shown = Application(behavior="key_press/move_on_key.yaml", cell=shipped_cell("servo_arm"), meanwhile=press)
    assert shown.run(tmp_path).outcome == "finished"
    assert [line for line in shown.left if "reached" in line] == ["root/over_water reached", "root/home reached"]
    for at_s, wanted in ((13.5, OVER_WATER_RAD), (25.5, HOME_RAD)):
        there = next(seen for seen in shown.seen if seen.time_s >= at_s)
        assert math.dist(there.joints.position_rad[:2], wanted) < 0.03, (at_s, there.joints)
    first = next(seen for seen in shown.seen if seen.time_s >= 1.9)
    assert max(map(abs, first.joints.velocity_rad_s)) < 0.01, "a key that means nothing moves nothing"
