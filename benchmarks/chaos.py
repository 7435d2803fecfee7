"""Random losses while two arms move in one cell: `python -P -m benchmarks.chaos [--trials N] [--seed S] [--losses …]`.

Each trial starts a real `flexcell serve` with two Pandas that plan around each other and a depth camera, waits a random
time, and then kills or suspends a process of it. It passes when everything came to rest, the cause is named, and the
cell goes on afterwards: the run is resumed (or says why not), or a new one runs. Exit code 1 when a trial fails.
A full disk is tried by the tests of the journal only; jumps of the system's clock are not tried.
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import httpx

from benchmarks.stop_server import Server, server

_FLEXCELL = Path(sys.executable).with_name("flexcell")
_BEHAVIOR = "behaviors/shared.yaml"
_REST_S = 5.0
_END_S = 20.0
_MOVING_S = 90.0
_LOOK_S = 0.01
_SUSPENDED_S = 1.0

CELL = """
flexcell: 1
cell: chaos
world: {kind: mujoco, step_s: 0.001}
robots:
  left: {model: panda, driver: sim, base: {xyz: [-0.55, 0, 0], rpy: [0, 0, 0]}}
  right: {model: panda, driver: sim, base: {xyz: [0.55, 0, 0], rpy: [0, 0, 3.141592653589793]}}
cameras:
  above: {at: [0, -1.6, 1.8], look_at: [0, 0, 0.4], size_px: [160, 120], rate_hz: 5}
occupancy: {center_m: [0, 0, 0.6], size_m: [1.2, 1.2, 0.8], voxel_m: 0.05}
"""
_ARM = """
      {robot}:
        machine:
          initial: there
          states:
            there:
              state: motion.MoveFree
              with: {{robot: {robot}, joints: [{turn}, -0.2, 0, -2.0, 0, 1.9, 0.8], speed: 0.3, patience_s: 60}}
              transitions: {{reached: back, blocked: ended, no_way: ended, failed: ended}}
            back:
              state: motion.MoveFree
              with: {{robot: {robot}, joints: [-{turn}, -0.2, 0, -2.0, 0, 1.9, 0.8], speed: 0.3, patience_s: 60}}
              transitions: {{reached: there, blocked: ended, no_way: ended, failed: ended}}
"""
BEHAVIOR = f"""
flexcell: 1
name: shared
cell: cell.yaml
outcomes: [ended]
success: []
root:
  concurrency:
    states:{_ARM.format(robot="left", turn=0.9)}{_ARM.format(robot="right", turn=0.7)}
    conditions:
      - {{ended: {{left: ended}}}}
      - {{ended: {{right: ended}}}}
"""


@dataclass(frozen=True, kw_only=True)
class Ended:
    """How a trial ended; `wrong` is empty where it passed."""

    loss: str
    rest_s: float | None
    cause: str
    after: str
    wrong: str = ""


class _Failed(Exception):
    """Something was not as it must be."""


def main() -> int:
    """Carry out the trials and print a line for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--losses", nargs="+", choices=list(_LOSSES), default=list(_LOSSES))
    options = parser.parse_args()
    failed = 0
    for number in range(options.trials):
        chance = random.Random(options.seed * 100_000 + number)
        ended = _trial(options.losses[number % len(options.losses)], chance)
        failed += bool(ended.wrong)
        rest = "-" if ended.rest_s is None else f"{ended.rest_s:.2f} s"
        print(f"{number:4} {ended.loss:18} rest {rest:>7}  {ended.after:24} {ended.wrong or ended.cause}", flush=True)
    print(f"{options.trials - failed} of {options.trials} trials passed")
    return 1 if failed else 0


def _trial(loss: str, chance: random.Random) -> Ended:
    with tempfile.TemporaryDirectory() as folder, server(Path(folder) / "cell", write_project=_write) as running:
        try:
            run = _moving_run(running)
            time.sleep(chance.uniform(0.0, 2.0))
            return _LOSSES[loss](running, run, loss)
        except (_Failed, httpx.HTTPError, OSError) as error:
            return Ended(loss=loss, rest_s=None, cause="", after="", wrong=f"FAILED: {error}")


def _engine_killed(running: Server, run: str, loss: str) -> Ended:
    began_s = time.monotonic()
    world = running.children("sim.process_main")[0]
    running.signal(signal.SIGKILL)
    rest_s = running.resting_since_s() - began_s
    _until(lambda: not _alive(world), _END_S, "the world's process lives on")
    done = subprocess.run(
        [_FLEXCELL, "resume", run, "--journal", "state", "--timeout", "3", "-q"],
        cwd=running.folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    if "Traceback" in done.stderr or done.returncode not in (1, 2, 3):
        raise _Failed(f"resume ended with {done.returncode}: {done.stderr[-200:]}")
    after = "says why not" if done.returncode == 2 else "resumed"
    cause = done.stderr.strip().splitlines()[-1] if done.stderr.strip() else done.stdout.strip()[-120:]
    return Ended(loss=loss, rest_s=max(0.0, rest_s), cause=cause, after=after)


def _engine_suspended(running: Server, run: str, loss: str) -> Ended:
    began_s = time.monotonic()
    running.signal(signal.SIGSTOP)
    rest_s = running.resting_since_s() - began_s
    time.sleep(_SUSPENDED_S)
    running.signal(signal.SIGCONT)
    cause = _cause(running, run, "silent")
    return Ended(loss=loss, rest_s=rest_s, cause=cause, after=_runs_again(running))


def _world_lost(running: Server, run: str, loss: str) -> Ended:
    number = signal.SIGKILL if loss == "world killed" else signal.SIGSTOP
    os.kill(running.children("sim.process_main")[0], number)
    cause = _cause(running, run, "SIGKILL" if loss == "world killed" else "not stepped")
    running.http.post("/api/v1/cell/connect", json={}).raise_for_status()
    running.look_at_world()
    return Ended(loss=loss, rest_s=None, cause=cause, after=_runs_again(running))


def _relay_killed(running: Server, run: str, loss: str) -> Ended:
    began_s = time.monotonic()
    os.kill(running.children("stop.process")[0], signal.SIGKILL)
    rest_s = running.resting_since_s() - began_s
    cause = _cause(running, run, "stop relay")
    _until(lambda: not running.children("sim.process_main"), _END_S, "the world's process lives on")
    running.http.post("/api/v1/cell/connect", json={}).raise_for_status()
    running.look_at_world()
    return Ended(loss=loss, rest_s=rest_s, cause=cause, after=_runs_again(running))


def _worker_killed(running: Server, run: str, loss: str) -> Ended:
    pids = running.children("planning.worker" if loss == "planner killed" else "vision.worker")
    if not pids:
        raise _Failed("there is no such process")
    os.kill(pids[0], signal.SIGKILL)
    time.sleep(_SUSPENDED_S)
    told = running.run(run)
    if told["status"] not in ("running", "finished", "errored") or (told["status"] != "running" and not told["cause"]):
        raise _Failed(f"the run is {told['status']} without a cause")
    after = "went on" if told["status"] == "running" else "ended"
    cause = str(told["cause"]) or "the run goes on"
    if told["status"] == "running":
        _stop(running)
    return Ended(loss=loss, rest_s=None, cause=cause, after=f"{after}; {_runs_again(running)}")


_LOSSES: dict[str, Callable[[Server, str, str], Ended]] = {
    "engine killed": _engine_killed,
    "engine suspended": _engine_suspended,
    "world killed": _world_lost,
    "world suspended": _world_lost,
    "relay killed": _relay_killed,
    "planner killed": _worker_killed,
    "camera killed": _worker_killed,
}


def _cause(running: Server, run: str, word: str) -> str:
    """Wait for the end of a run and return its cause, which must hold `word`."""
    _until(lambda: running.run(run)["status"] not in ("running", "stopping"), _END_S, "the run does not end")
    cause = str(running.run(run)["cause"])
    if word not in cause:
        raise _Failed(f"the cause does not say {word!r}: {cause}")
    return cause


def _runs_again(running: Server) -> str:
    """Start a new run, wait until an arm moves, stop it, and wait until everything rests."""
    _moving_run(running)
    _stop(running)
    return "runs again"


def _moving_run(running: Server) -> str:
    """Start a run and return its id once an arm moves; it is refused as long as the cameras have seen nothing yet."""
    deadline_s = time.monotonic() + _MOVING_S
    run = ""
    while time.monotonic() < deadline_s:
        run = running.start(_BEHAVIOR)
        while running.run(run)["status"] == "running":
            if not running.heartbeat.at_rest_since_ns:
                return run
            time.sleep(_LOOK_S)
        time.sleep(_SUSPENDED_S)
    raise _Failed(f"no arm moves within {_MOVING_S:g} s: {running.run(run)['cause']}")


def _stop(running: Server) -> None:
    running.http.post("/api/v1/cell/stop", json={"reason": "the trial is over"}).raise_for_status()
    running.wait_until_idle()
    _until(lambda: bool(running.heartbeat.at_rest_since_ns), _REST_S, "an arm does not come to rest")


def _until(true: Callable[[], bool], limit_s: float, otherwise: str) -> None:
    deadline_s = time.monotonic() + limit_s
    while not true():
        if time.monotonic() > deadline_s:
            raise _Failed(f"{otherwise} within {limit_s:g} s")
        time.sleep(_LOOK_S)


def _alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def _write(folder: Path) -> None:
    (folder / "behaviors").mkdir(parents=True)
    (folder / "behaviors" / "cell.yaml").write_text(CELL, encoding="utf-8")
    (folder / _BEHAVIOR).write_text(BEHAVIOR, encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
