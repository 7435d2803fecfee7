"""The skills of an arm from the command line: services and goals, also those that go wrong."""

from __future__ import annotations

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from engine.bus import GoalStatus
from engine.bus.json_bus import LocalJsonBus
from engine.cli.commands.bus import repeat
from engine.cli.main import app
from engine.skills.direct_control import SwitchDirectControl
from engine.skills.jogging import JogTool
from tests.robots.arm.simulated import CELL, simulated
from tests.robots.panda_arm import home

WHERE = ("--cell", str(CELL))


def test_a_service_of_an_arm_is_reached_by_its_name_and_answers_as_json() -> None:
    """What is in force afterwards."""
    said = CliRunner().invoke(app, ["bus", "call", "left/set_speed_override", '{"share": 0.25}', *WHERE])
    assert json.loads(said.stdout)["speed_override"] == 0.25


def test_a_goal_that_is_rejected_says_why_and_has_an_exit_code_of_its_own() -> None:
    """Nothing has moved."""
    said = CliRunner().invoke(app, ["bus", "goal", "left/jog_joints", '{"duration_s": 1.0}', *WHERE])
    assert (said.exit_code, json.loads(said.stdout)["status"]) == (1, "rejected")
    assert "a velocity and `duration_s` are only valid together" in said.stderr


def test_a_message_is_published_as_often_as_requested() -> None:
    """Nobody jogs at present, so that nothing moves."""
    message = '{"velocity": [0, 0, -0.02, 0, 0, 0]}'
    said = CliRunner().invoke(app, ["bus", "publish", "left/jog", message, "--rate", "50", "--for", "0.1", *WHERE])
    assert (said.exit_code, said.stdout) == (0, ""), said.output


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("left/jog", '{"speed": 1}'), "this is not a JogCommand: object contains unknown field `speed`"),
        (("left/status", "{}"), "commands are taken on left/direct_joints, left/jog"),
        (("left/jok", "{}"), "no such topic"),
        (("left/jog", "{}", "--for", "1"), "--for requires --rate"),
    ],
)
def test_what_cannot_be_published_says_why(arguments: tuple[str, ...], words: str) -> None:
    """In one line, as all commands do."""
    said = CliRunner().invoke(app, ["bus", "publish", *arguments, *WHERE])
    assert said.exit_code != 0
    assert words in str(said.exception)


@pytest.mark.virtual
async def test_hold_to_run_from_the_command_line_moves_the_tool_while_it_is_published_and_no_longer() -> None:
    """For a second at 20 Hz; after it the watchdog brakes and the goal ends by itself."""
    async with simulated() as cell:
        bus = LocalJsonBus(cell.bus)
        handle = await cell.begun(JogTool(idle_s=0.5), after_s=0.1)
        start = await cell.tool()

        async def down() -> None:
            await bus.publish("left/jog", {"velocity": [0, 0, -0.05, 0, 0, 0]})

        await repeat(down, rate_hz=20.0, duration_s=1.0)
        end = await handle.result()
        there = await cell.tool()
    assert end.status is GoalStatus.SUCCEEDED
    assert start.xyz[2] - there.xyz[2] == pytest.approx(0.05, abs=0.015)


@pytest.mark.virtual
async def test_set_points_from_the_command_line_lead_the_arm_under_direct_control() -> None:
    async with simulated() as cell:
        bus = LocalJsonBus(cell.bus)
        assert (await cell.bus.call(SwitchDirectControl(on=True, watchdog_s=0.2), to="left")).success
        turned = home() + np.array((0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))

        async def turn() -> None:
            await bus.publish("left/direct_joints", {"position_rad": turned.tolist()})

        await repeat(turn, rate_hz=20.0, duration_s=1.5)
        assert (await cell.bus.call(SwitchDirectControl(on=False), to="left")).success
        assert np.abs(cell.joints() - turned).max() < 0.01
