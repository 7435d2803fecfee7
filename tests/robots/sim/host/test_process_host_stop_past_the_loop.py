"""STOP reaches a moving arm of the real world's process while the engine's event loop is blocked."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Any

from engine.stop import StopNotice, StopRelay
from robots.port import MotionEnd, Tolerance
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld
from tests.engine.stop.device import endpoint_of, post, posted
from tests.robots.sim.sim_cell import HOME, move, one_arm, smooth, until

SLOW_S = 60.0


def while_blocked(call: Callable[[], Any]) -> Any:
    """Call on another thread, holding this one, the event loop's, until it returns."""
    answers: list[Any] = []
    thread = threading.Thread(target=lambda: answers.append(call()))
    thread.start()
    thread.join()
    return answers[0]


async def test_an_arm_stops_while_the_loop_is_blocked_and_moves_again_only_when_the_engine_has_ended_its_runs() -> None:
    carried_out = asyncio.Event()
    runs_have_ended = asyncio.Event()

    async def end_runs(_notice: StopNotice) -> None:
        carried_out.set()
        await runs_have_ended.wait()

    async with StopRelay(host="127.0.0.1") as relay:
        relay.on_stop(end_runs)
        endpoint = endpoint_of(relay)
        async with SimWorld(one_arm(), host=ProcessHost(one_arm(), new_stop_line=relay.new_line)) as world:
            arm = world.arm("left")
            motion = arm.follow(smooth(HOME, HOME + 0.5, SLOW_S), tolerance=Tolerance())
            await until(lambda: motion.progress > 0.0)
            told = while_blocked(lambda: post(endpoint, reason="a hand in the cell")).json()
            while not told["at_rest"]:
                told = while_blocked(lambda: post(endpoint, path="/status")).json()
            assert (told["engine"], told["devices"][0]["name"]) == ("silent", "world")

            report = await motion.report()
            assert (report.end, report.reason) == (
                MotionEnd.FAILED,
                "STOP: a hand in the cell; left came to rest by itself",
            )
            await carried_out.wait()
            refused = await move(arm, HOME + 0.1)
            assert (refused.end, refused.reason[:24]) == (MotionEnd.FAILED, "STOP: a hand in the cell")

            runs_have_ended.set()
            while (again := await move(arm, HOME + 0.1)).end is not MotionEnd.REACHED:
                # The release is on its way to the world's process.
                assert again.reason.startswith("STOP: a hand in the cell")


async def test_a_world_whose_relay_is_gone_ends_at_rest_and_both_come_back() -> None:
    async with (
        StopRelay() as relay,
        SimWorld(one_arm(), host=ProcessHost(one_arm(), new_stop_line=relay.new_line)) as world,
    ):
        motion = world.arm("left").follow(smooth(HOME, HOME + 0.5, SLOW_S), tolerance=Tolerance())
        await until(lambda: motion.progress > 0.0)
        relay.kill()
        report = await motion.report()
        assert report.reason == "STOP: the stop line is cut: the stop relay has ended; left came to rest by itself"
        await until(lambda: bool(world.lost_reason and relay.lost_reason))
        assert relay.lost_reason == "the stop relay has ended by SIGKILL"

        await relay.reconnect()
        await world.reconnect()
        assert (relay.lost_reason, world.lost_reason) == ("", "")
        assert (await move(world.arm("left"), HOME + 0.1)).end is MotionEnd.REACHED
        assert await relay.order("again") == 1


async def test_two_stops_in_a_row_are_one() -> None:
    async with StopRelay(host="127.0.0.1") as relay:
        endpoint = endpoint_of(relay)
        async with SimWorld(one_arm(), host=ProcessHost(one_arm(), new_stop_line=relay.new_line)) as world:
            motion = world.arm("left").follow(smooth(HOME, HOME + 0.5, SLOW_S), tolerance=Tolerance())
            await until(lambda: motion.progress > 0.0)
            first, second = await posted(endpoint, reason="first"), await posted(endpoint, reason="second")
            report = await motion.report()
    assert (first.json()["stop"], second.json()["stop"]) == (1, 2)
    assert report.reason.startswith("STOP: first")
