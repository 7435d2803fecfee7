"""Devices behind their drivers beside the simulated arm: `python -P -m benchmarks.drivers [--rounds 10]`.

Arms stand behind one port, a gripper and a hand behind theirs. Real ones are emulated in processes of their own and
reached through their client libraries and the wire, so that what is measured is the driver and not a robot: what is
emulated has no dynamics, but for the FR3, which franky-sim simulates in MuJoCo. Measured are

* command → motion: from `follow` until the measured joints move,
* deviation: the largest difference between set point and measured joints along a smooth path,
* cancel → rest: from `cancel` in the middle of a fast path until its report, and how far the joints went meanwhile,
* stream: set points sent 100 times a second for some seconds; how regular the measurements of the loop are that follow
  them, and how many periods it has missed,
* link cut → named: until the driver says so; → rest: until the emulated arm rests, in its own time,
* link restored → reading: until the driver reads again.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import math
import time
from collections.abc import Callable
from contextlib import AbstractAsyncContextManager
from dataclasses import asdict
from pathlib import Path

import numpy as np

from benchmarks.comparison import machine
from benchmarks.driver_arms import Subject, abb_irc5, franka, lose_link, servo_arm, simulated, universal_robots
from benchmarks.driver_figures import POLL_S, Cycles, Figures, table, until
from benchmarks.driver_tools import TOOLS, measure_tool
from robots.port import ArmPort, Motion

_MOVES_RAD_S = 0.02
_STREAM_HZ, _STREAM_S = 100.0, 4.0
_AMPLITUDE_RAD, _FREQUENCY_HZ = 0.05, 0.5


async def measure(name: str, subject: Subject, rounds: int) -> Figures:
    """Measure one arm."""
    figures = Figures(arm=name)
    for _ in range(rounds):
        await _start_and_follow(subject, figures)
        await _cancel(subject, figures)
    if subject.beats is not None:
        figures.cycles = await _stream(subject, subject.beats)
    if subject.link is not None:
        for _ in range(rounds):
            await lose_link(subject, figures)
    return figures


async def _start_and_follow(subject: Subject, figures: Figures) -> None:
    port = subject.port
    path = subject.path(subject.near, 1.0)
    start_time_s = time.perf_counter()
    motion = port.follow(path, tolerance=subject.tolerance)
    await until(lambda: _speed(port) > _MOVES_RAD_S)
    figures.start_s.append(time.perf_counter() - start_time_s)
    ending = asyncio.create_task(motion.report())
    largest = 0.0
    while not ending.done():
        sample = port.sample()
        largest = max(largest, float(np.abs(sample.desired_rad - sample.position_rad).max()))
        await asyncio.sleep(POLL_S)
    if ending.result().reason:
        raise SystemExit(f"the arm did not reach its goal: {ending.result().reason}")
    if subject.follows:
        figures.deviation_rad.append(largest)
    await subject.go(subject.start)


async def _cancel(subject: Subject, figures: Figures) -> None:
    port = subject.port
    motion = subject.move(subject.far, 2.5)
    await _progressed(motion, 0.4)
    before, start_time_s = np.array(port.sample().position_rad), time.perf_counter()
    motion.cancel()
    await motion.report()
    figures.cancel_s.append(time.perf_counter() - start_time_s)
    figures.cancel_rad.append(float(np.abs(port.sample().position_rad - before).max()))
    await subject.go(subject.start, 2.5)


async def _stream(subject: Subject, beats: Callable[[], tuple[int, float]]) -> Cycles:
    """Send set points, and watch the measurements of the loop that follows them."""
    start = np.array(subject.port.sample().desired_rad)
    stream = subject.port.stream("joint_position", watchdog_s=1.0)
    intervals: list[float] = []
    first = last = beats()
    start_time_s = sent_s = time.perf_counter()
    while (now_s := time.perf_counter()) - start_time_s < _STREAM_S:
        if now_s - sent_s >= 1.0 / _STREAM_HZ:
            sent_s = now_s
            offset = _AMPLITUDE_RAD * math.sin(2.0 * math.pi * _FREQUENCY_HZ * (now_s - start_time_s))
            stream.send(tuple((start + offset).tolist()))
        beat = beats()
        if beat[0] > last[0]:
            intervals += [(beat[1] - last[1]) / (beat[0] - last[0])] * (beat[0] - last[0])
            last = beat
        await asyncio.sleep(POLL_S)
    elapsed_s = last[1] - first[1]
    stream.finish()
    await stream.report()
    await subject.go(subject.start)
    p50, p99, most = np.quantile(intervals, (0.5, 0.99, 1.0)).tolist()
    missed = max(0.0, 1.0 - (last[0] - first[0]) * subject.period_s / elapsed_s)
    return Cycles(period_s=subject.period_s, p50_s=p50, p99_s=p99, max_s=most, missed_share=missed)


async def _progressed(motion: Motion, share: float) -> None:
    """Return once the motion has come so far; it must not have ended."""
    ending = asyncio.create_task(motion.report())
    await until(lambda: motion.progress > share or ending.done())
    if ending.done():
        raise SystemExit(f"the motion ended early: {ending.result().reason}")
    ending.cancel()


def _speed(port: ArmPort) -> float:
    return float(np.abs(port.sample().velocity_rad_s).max())


ARMS: dict[str, Callable[[], AbstractAsyncContextManager[Subject]]] = {
    "simulated": simulated,
    "UR CB3 (ur-rtde)": lambda: universal_robots("cb3"),
    "UR e-Series (ur-rtde)": lambda: universal_robots("e"),
    "ABB IRC5": abb_irc5,
    "servo arm": servo_arm,
    "Franka FR3": franka,
}


async def _main(rounds: int, only: str) -> list[Figures]:
    measured: list[Figures] = []
    for name, opened in ARMS.items():
        if only in name:
            async with opened() as subject:
                measured.append(await measure(name, subject, rounds))
    for name, opened_tool in TOOLS.items():
        if only in name:
            async with opened_tool() as tool:
                measured.append(await measure_tool(name, tool, rounds))
    return measured


def main() -> None:
    """Measure all devices and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--rounds", type=int, default=10, help="motions, cancels and cuts per device (default 10)")
    parser.add_argument("--only", default="", metavar="NAME", help="devices whose name has NAME in it")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every sample to FILE")
    options = parser.parse_args()
    measured = asyncio.run(_main(options.rounds, options.only))
    print(f"{options.rounds} rounds each; {machine()}.\n\n{table(measured)}")
    if options.json:
        options.json.write_text(json.dumps([asdict(each) for each in measured], indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
