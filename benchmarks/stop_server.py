"""A real `flexcell serve` with moving arms: started, blocked, killed, looked at; for `stop.py` and `chaos.py`."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx

from benchmarks.process_cpu import descendants
from robots.port.heartbeat import Heartbeat

_ROOT = Path(__file__).parents[1]
FLEXCELL = Path(sys.executable).with_name("flexcell")
_MOVING_S = 0.4
_LOOK_S = 0.002
_START_S = 20.0
_LOOKS_A_RUN = 50
_ACTIVE = ("running", "stopping")
_REST_S = 10.0
_ITEMS = 38
# 1,444 rounds: nearly as much as one evaluation may cost.
_HEAVY = "items.all(i, items.all(j, i + j >= 0))"

CELL = """
flexcell: 1
cell: stop
world: {kind: mujoco, step_s: 0.001}
robots:
  left: {model: panda, driver: sim, base: {xyz: [0, 0, 0], rpy: [0, 0, 0]}}
"""
BEHAVIOR = """
flexcell: 1
name: swing
cell: cell.yaml
parameters:
  how: {type: string, default: none}
  for_s: {type: number, default: 1.0}
  marker: {type: string, default: ""}
  items: {type: list, default: ITEMS}
outcomes: [ended]
success: [ended]
root:
  concurrency:
    states:
      arm:
        machine:
          initial: there
          states:
            there:
              state: motion.MoveJoints
              with: {robot: left, target: [1.2, -0.4, 0, -2.2, 0, 1.8, 0.8], speed: 0.4}
              transitions: {reached: back, failed: ended}
            back:
              state: motion.MoveJoints
              with: {robot: left, target: [-1.2, -0.4, 0, -2.2, 0, 1.8, 0.8], speed: 0.4}
              transitions: {reached: there, failed: ended}
      block:
        state: stop_states:Block
        with: {how: "${how}", after_s: AFTER, for_s: "${for_s}", marker: "${marker}"}
      think:
        machine:
          initial: again
          states:
            again:
              state: flow.Wait
              with: {duration_s: "${how != 'expression' ? 3600.0 : HEAVY ? 0.001 : 0.002}"}
              transitions: {done: again}
    conditions:
      - {ended: {arm: ended}}
      - {ended: {block: done}}
"""


class Server:
    """One server and its processes."""

    def __init__(self, process: subprocess.Popen[bytes], folder: Path, *, state: Path) -> None:
        self.process = process
        self.folder = folder
        self.state = state
        self.record: dict[str, Any] = json.loads((state / "server.json").read_bytes())
        self.http = httpx.Client(
            base_url=self.record["url"],
            headers={"Authorization": f"Bearer {self.record['token']}"},
            timeout=60.0,
            trust_env=False,
            # The server closes what was idle for some seconds; an order that is sent at that very moment would be lost.
            limits=httpx.Limits(max_keepalive_connections=0),
        )
        self.look_at_world()

    def start_run(self, how: str, for_s: float) -> None:
        """Start the arm and return when it moves, just before the loop is blocked in this way.

        A run that the page's second order of the STOP before ends is started again.

        Raises:
            TimeoutError: the arm does not move; says what the run says.
        """
        marker = self.folder / "moving"
        marker.write_bytes(b"")
        parameters = {"how": how, "for_s": for_s, "marker": str(marker)}
        run = self.start("behaviors/swing.yaml", parameters)
        deadline_s = time.monotonic() + _START_S
        looks = 0
        while not marker.read_bytes():
            looks += 1
            if looks % _LOOKS_A_RUN == 0 and self.run(run)["status"] not in _ACTIVE:
                run = self.start("behaviors/swing.yaml", parameters)
            if time.monotonic() > deadline_s:
                raise TimeoutError(f"the arm does not move: {self.run(run)['cause']}")
            time.sleep(_LOOK_S)

    def start(self, behavior: str, parameters: Mapping[str, object] | None = None) -> str:
        """Start a run and return its id; raises HTTPStatusError where it is refused."""
        body = {"behavior": behavior, "parameters": dict(parameters or {}), "seed": 1}
        return str(self.http.post("/api/v1/runs", json=body).raise_for_status().json()["run"])

    def run(self, run_id: str) -> dict[str, Any]:
        """Return a run as the server tells it."""
        return next(run for run in self.http.get("/api/v1/runs").json() if run["id"] == run_id)

    def children(self, what: str) -> list[int]:
        """Return the processes of the server whose command names `what`."""
        return [pid for pid in descendants(self.process.pid) if what.encode() in _command(pid)]

    def look_at_world(self) -> None:
        """Read the heartbeat of the present world's process from now on.

        Raises:
            ProcessLookupError: there is none; the server's log says why.
        """
        worlds = self.children("sim.process_main")
        if not worlds:
            lines = (self.folder / "log").read_text(encoding="utf-8", errors="replace").splitlines()
            raise ProcessLookupError(f"the server has no world: {' | '.join(lines[-3:])}")
        self.heartbeat = Heartbeat.of_process(worlds[0])

    def wait_until_idle(self) -> None:
        """Wait until no run is active, and release the last stop: devices take motions, and runs start again."""
        while any(run["status"] in _ACTIVE for run in self.http.get("/api/v1/runs").json()):
            time.sleep(0.02)
        if self.http.get("/api/v1/cell/stop").json() is not None:
            self.http.post("/api/v1/cell/stop/release", json={}).raise_for_status()

    def resting_since_s(self) -> float:
        """Wait until the world's own process measures rest and return since when, on the monotonic clock.

        Raises:
            TimeoutError: something still moves.
        """
        deadline_s = time.monotonic() + _REST_S
        while not (since_ns := self.heartbeat.at_rest_since_ns):
            if time.monotonic() > deadline_s:
                raise TimeoutError(f"not everything is at rest within {_REST_S:g} s")
            time.sleep(_LOOK_S)
        return since_ns / 1e9

    def signal(self, number: signal.Signals) -> None:
        """Send a signal to the engine's process."""
        os.kill(self.process.pid, number)

    def close(self) -> None:
        """Close what looks at it."""
        self.http.close()
        self.heartbeat.close()


def write_swing(folder: Path) -> None:
    """Write a project with one arm that swings, and a state that blocks."""
    (folder / "behaviors").mkdir(parents=True)
    (folder / "behaviors" / "cell.yaml").write_text(CELL, encoding="utf-8")
    items = json.dumps(list(range(_ITEMS)))
    behavior = BEHAVIOR.replace("AFTER", str(_MOVING_S)).replace("HEAVY", _HEAVY).replace("ITEMS", items)
    (folder / "behaviors" / "swing.yaml").write_text(behavior, encoding="utf-8")
    (folder / "flexcell.yaml").write_text("flexcell: 1\nstates: [stop_states]\n", encoding="utf-8")
    shutil.copy(Path(__file__).with_name("stop_states.py"), folder / "stop_states.py")


@contextmanager
def server(
    folder: Path,
    *,
    write_project: Callable[[Path], None] = write_swing,
    environment: Mapping[str, str] | None = None,
    disk: str = "",
) -> Generator[Server]:
    """Start a server in a new project, whose cell is `behaviors/cell.yaml`, and kill what is left of it at the end.

    Args:
        folder: Of the project.
        write_project: Writes it.
        environment: Of its processes, beside that of this one.
        disk: Size of a disk in memory that holds its state folder, as mount takes it; empty for none.
    """
    write_project(folder)
    (folder / "state").mkdir(mode=0o700)
    command = [str(FLEXCELL), "serve", "--cell", "behaviors/cell.yaml", "--port", "0", "--state", "state"]
    command.append("--no-record")
    if disk:
        script = f'mount -t tmpfs -o size={disk},mode=700 none state && exec "$0" "$@"'
        command = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", script, *command]
    around = {**os.environ, "PYTHONPATH": str(_ROOT), **(environment or {})}
    with (folder / "log").open("wb") as log:
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=log, env=around)
    assert process.stdout is not None
    # What is mounted for a process is seen by others below its own root only.
    seen_from = Path(f"/proc/{process.pid}/root") if disk else Path("/")
    try:
        for line in process.stdout:
            if line.startswith(b"Dashboard:"):
                break
        running = Server(process, folder, state=seen_from / folder.relative_to("/") / "state")
        try:
            yield running
        finally:
            running.close()
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def _command(pid: int) -> bytes:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return b""
