"""What is lost in a trial of `chaos.py`, and what must be so afterwards."""

from __future__ import annotations

import errno
import os
import random
import signal
import subprocess
import time
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from email.utils import parsedate_to_datetime
from functools import partial
from pathlib import Path

import libfaketime

from benchmarks.chaos_cell import BEHAVIOR, write_project
from benchmarks.stop_server import FLEXCELL, Server, server

_REST_S = 5.0
_END_S = 20.0
_MOVING_S = 90.0
_LOOK_S = 0.01
_SUSPENDED_S = 1.0
_DISK = "24m"
_BLOCK_BYTES = 65_536
_CLOCK = "clock"
_CLOCK_NEAR_S = 5.0
_JUMPS_S = (3_600.0, 86_400.0)


@dataclass(frozen=True, kw_only=True)
class LossResult:
    """How a trial ended; `wrong` is empty where it passed."""

    rest_s: float | None = None
    cause: str = ""
    after: str = ""
    wrong: str = ""


class TrialFailure(Exception):
    """Something was not as it must be."""


def _engine_killed(running: Server, run: str, _chance: random.Random) -> LossResult:
    started_s = time.monotonic()
    world = running.children("sim.process_main")[0]
    running.signal(signal.SIGKILL)
    rest_s = running.resting_since_s() - started_s
    _until(lambda: not _alive(world), _END_S, "the world's process lives on")
    done = subprocess.run(
        [FLEXCELL, "resume", run, "--journal", "state", "--timeout", "3", "-q"],
        cwd=running.folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    if "Traceback" in done.stderr or done.returncode not in (1, 2, 3):
        raise TrialFailure(f"resume ended with {done.returncode}: {done.stderr[-200:]}")
    after = "says why not" if done.returncode == 2 else "resumed"
    cause = done.stderr.strip().splitlines()[-1] if done.stderr.strip() else done.stdout.strip()[-120:]
    return LossResult(rest_s=max(0.0, rest_s), cause=cause, after=after)


def _engine_suspended(running: Server, run: str, _chance: random.Random) -> LossResult:
    started_s = time.monotonic()
    running.signal(signal.SIGSTOP)
    rest_s = running.resting_since_s() - started_s
    time.sleep(_SUSPENDED_S)
    running.signal(signal.SIGCONT)
    cause = _cause(running, run, "silent")
    return LossResult(rest_s=rest_s, cause=cause, after=_runs_again(running))


def _world_lost(running: Server, run: str, _chance: random.Random, *, by: signal.Signals, word: str) -> LossResult:
    os.kill(running.children("sim.process_main")[0], by)
    cause = _cause(running, run, word)
    running.http.post("/api/v1/cell/connect", json={}).raise_for_status()
    running.look_at_world()
    return LossResult(cause=cause, after=_runs_again(running))


def _relay_killed(running: Server, run: str, _chance: random.Random) -> LossResult:
    started_s = time.monotonic()
    os.kill(running.children("stop.process")[0], signal.SIGKILL)
    rest_s = running.resting_since_s() - started_s
    cause = _cause(running, run, "stop relay")
    _until(lambda: not running.children("sim.process_main"), _END_S, "the world's process lives on")
    running.http.post("/api/v1/cell/connect", json={}).raise_for_status()
    running.look_at_world()
    return LossResult(rest_s=rest_s, cause=cause, after=_runs_again(running))


def _worker_killed(running: Server, run: str, _chance: random.Random, *, worker: str) -> LossResult:
    pids = running.children(worker)
    if not pids:
        raise TrialFailure("there is no such process")
    os.kill(pids[0], signal.SIGKILL)
    time.sleep(_SUSPENDED_S)
    view = running.run(run)
    if view["status"] not in ("running", "finished", "errored") or (view["status"] != "running" and not view["cause"]):
        raise TrialFailure(f"the run is {view['status']} without a cause")
    after = "went on" if view["status"] == "running" else "ended"
    cause = str(view["cause"]) or "the run goes on"
    if view["status"] == "running":
        _stop(running)
    return LossResult(cause=cause, after=f"{after}; {_runs_again(running)}")


def _disk_full(running: Server, run: str, _chance: random.Random) -> LossResult:
    started_s = time.monotonic()
    filler = running.state / "filler"
    with filler.open("wb", buffering=0) as file:
        try:
            while file.write(bytes(_BLOCK_BYTES)):
                pass
        except OSError as error:
            if error.errno != errno.ENOSPC:
                raise
        cause = _cause(running, run, "the journal cannot be written")
    rest_s = running.resting_since_s() - started_s
    filler.unlink()
    return LossResult(rest_s=rest_s, cause=cause, after=_runs_again(running))


def _clock_jumps(running: Server, run: str, chance: random.Random, *, sign: int) -> LossResult:
    """The run goes on through a jump of the system's clock and one back."""
    by_s = sign * chance.uniform(*_JUMPS_S)
    _jump(running.folder.parent, by_s)
    _until(lambda: abs(_clock_s(running) - time.time() - by_s) < _CLOCK_NEAR_S, _END_S, "the clock has not jumped")
    _jump(running.folder.parent, 0.0)
    time.sleep(_SUSPENDED_S)
    _until(lambda: not running.heartbeat.at_rest_since_ns, _END_S, "no arm moves after the jumps")
    view = running.run(run)
    if view["status"] != "running":
        raise TrialFailure(f"the run is {view['status']}: {view['cause']}")
    _stop(running)
    return LossResult(cause=f"by {by_s:+.0f} s; the run goes on", after=_runs_again(running))


def _clock_s(running: Server) -> float:
    """The time that the server's answers are dated with."""
    return parsedate_to_datetime(running.http.get("/api/v1/runs").headers["date"]).timestamp()


def _jump(folder: Path, by_s: float) -> None:
    """Set the clock of a server's processes; in one step, so that none reads half a number."""
    written = folder / "clock.new"
    written.write_text(f"{by_s:+.3f}\n", encoding="ascii")
    written.rename(folder / _CLOCK)


@dataclass(frozen=True, kw_only=True)
class Loss:
    """Something that is lost: `happens` takes server, run, and the trial's chance; `disk` is as for `server`."""

    happens: Callable[[Server, str, random.Random], LossResult]
    disk: str = ""
    sets_clock: bool = False

    @contextmanager
    def server(self, folder: Path) -> Generator[Server]:
        """Start a server of the cell to which this can happen."""
        environment: Mapping[str, str] = {}
        if self.sets_clock:
            folder.parent.mkdir(parents=True, exist_ok=True)
            _jump(folder.parent, 0.0)
            _, preloaded = libfaketime.get_reload_information()
            environment = {**preloaded, "FAKETIME_TIMESTAMP_FILE": str(folder.parent / _CLOCK)}
        with server(folder, write_project=write_project, environment=environment, disk=self.disk) as running:
            yield running


LOSSES: dict[str, Loss] = {
    "engine killed": Loss(happens=_engine_killed),
    "engine suspended": Loss(happens=_engine_suspended),
    "world killed": Loss(happens=partial(_world_lost, by=signal.SIGKILL, word="SIGKILL")),
    "world suspended": Loss(happens=partial(_world_lost, by=signal.SIGSTOP, word="not stepped")),
    "relay killed": Loss(happens=_relay_killed),
    "planner killed": Loss(happens=partial(_worker_killed, worker="planning.worker")),
    "camera killed": Loss(happens=partial(_worker_killed, worker="vision.worker")),
    "disk full": Loss(happens=_disk_full, disk=_DISK),
    "clock set on": Loss(happens=partial(_clock_jumps, sign=1), sets_clock=True),
    "clock set back": Loss(happens=partial(_clock_jumps, sign=-1), sets_clock=True),
}


def _cause(running: Server, run: str, word: str) -> str:
    """Wait for the end of a run and return its cause, which must hold `word`."""
    _until(lambda: running.run(run)["status"] not in ("running", "stopping"), _END_S, "the run does not end")
    cause = str(running.run(run)["cause"])
    if word not in cause:
        raise TrialFailure(f"the cause does not say {word!r}: {cause}")
    return cause


def _runs_again(running: Server) -> str:
    """Start a new run, wait until an arm moves, stop it, and wait until everything is at rest."""
    moving_run(running)
    _stop(running)
    return "runs again"


def moving_run(running: Server) -> str:
    """Start a run and return its id once an arm moves; it is refused as long as the cameras have seen nothing yet."""
    deadline_s = time.monotonic() + _MOVING_S
    run = ""
    while time.monotonic() < deadline_s:
        run = running.start(BEHAVIOR)
        while running.run(run)["status"] == "running":
            if not running.heartbeat.at_rest_since_ns:
                return run
            time.sleep(_LOOK_S)
        time.sleep(_SUSPENDED_S)
    raise TrialFailure(f"no arm moves within {_MOVING_S:g} s: {running.run(run)['cause']}")


def _stop(running: Server) -> None:
    running.http.post("/api/v1/cell/stop", json={"reason": "the trial is over"}).raise_for_status()
    running.wait_until_idle()
    _until(lambda: bool(running.heartbeat.at_rest_since_ns), _REST_S, "an arm does not come to rest")


def _until(true: Callable[[], bool], limit_s: float, otherwise: str) -> None:
    deadline_s = time.monotonic() + limit_s
    while not true():
        if time.monotonic() > deadline_s:
            raise TrialFailure(f"{otherwise} within {limit_s:g} s")
        time.sleep(_LOOK_S)


def _alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False
