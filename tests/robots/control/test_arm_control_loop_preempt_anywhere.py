"""Whatever an arm does and whenever it is told to stop: no limit is passed, it comes to rest, the next goal works.

The watch of the control loop looks at every set point and fails the test where one exceeds a limit; 210 stops in all.
"""

from __future__ import annotations

import random

import numpy as np
import pytest

from engine.skills.arm_control import ControlSettings
from engine.skills.simulated_world import PushBody
from robots.control.commanding.arm_commands import ConfigureArm, RecoverArm
from robots.port import MotionEnd
from robots.scene.sim_scene import SimScene
from robots.sim.commands.world_commands import PushSimBody
from robots.sim.physics.cell_model import CellModel, build_cell
from tests.robots.control.arm_orders import STARTS, Start, WatchedArm, follow, stop
from tests.robots.sim.sim_cell import LEFT, PANDA

TRIALS = 30
REST_RAD_S = 0.02


@pytest.fixture(scope="module", name="cell")
def _cell() -> CellModel:
    return build_cell(SimScene(arms=(LEFT,)))


@pytest.mark.parametrize("start", STARTS, ids=lambda start: start.__name__)
def test_a_stop_at_any_instant_keeps_the_limits_and_ends_at_rest(cell: CellModel, start: Start) -> None:
    random_ = random.Random(start.__name__)
    arm = WatchedArm(cell, PANDA)
    for _ in range(TRIALS):
        start(arm, random_)
        for _ in range(random_.randrange(250)):
            arm.step()
        stop(arm, random_)
        end = arm.until_ended()
        assert (end.motion, end.report.reason) == (arm.number, "")
        assert np.abs(arm.control.state.velocity).max() < REST_RAD_S
        assert np.abs(arm.control.motion.velocity).max() == 0.0


def test_a_reflex_at_any_instant_keeps_the_limits_and_ends_at_rest(cell: CellModel) -> None:
    """A knock on the way stops the arm; once it has recovered, the next motion trips again."""
    random_ = random.Random(5)
    arm = WatchedArm(cell, PANDA)
    arm.simulation.apply(ConfigureArm(arm="left", settings=ControlSettings(collision_force_n=20.0)))
    for _ in range(10):
        follow(arm, random_)
        for _ in range(random_.randrange(20, 250)):
            arm.step()
        arm.simulation.apply(
            PushSimBody(push=PushBody(body="left/panda_hand", force_n=(0.0, 60.0, 0.0), duration_s=0.02))
        )
        arm.until_ended()
        assert (arm.ends[-1].report.end, arm.control.reflex) == (MotionEnd.FAILED, True)
        assert arm.ends[-1].report.reason.startswith("external force limit exceeded")
        assert np.abs(arm.control.state.velocity).max() < REST_RAD_S
        arm.simulation.apply(RecoverArm(arm="left"))
        arm.step()
        assert not arm.control.reflex
