"""Starts the real server again and again while clients reconnect to it from before its first moment.

`python -m benchmarks.server_startup --starts 50` prints how many starts ended as they should, and by which
signal the others died. Threads change places every microsecond, which finds what a race can do.
"""

from __future__ import annotations

import argparse
import http.client
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from pathlib import Path
from threading import Barrier, Event

from editor_web.security.authentication import load_access_tokens

_PROGRAM = "import sys; sys.setswitchinterval(1e-6); from engine.cli.main import main; main()"
_BEHAVIOR = """\
flexcell: 1
name: {name}
outcomes: [done]
success: [done]
root:
  machine:
    initial: wait
    states:
      wait: {{state: flow.Wait, with: {{duration_s: 1}}, transitions: {{done: done}}}}
"""
_BEHAVIORS = 5
_PATHS = ("/api/v1/behaviors", "/api/v1/catalogue", "/api/v1/documents?id=behaviors/b0.yaml")
_ROUNDS = 2
_GIVE_UP_S = 300.0


def new_project(folder: Path) -> None:
    """Write a few behaviors into a folder that the server can list."""
    (folder / "behaviors").mkdir()
    for number in range(_BEHAVIORS):
        name = f"b{number}"
        (folder / "behaviors" / f"{name}.yaml").write_text(_BEHAVIOR.format(name=name), encoding="utf-8")


def start_server_once(folder: Path, *, clients: int, host: str = "127.0.0.1") -> str:
    """Start the server in a project, have clients ask until each was answered, and stop it.

    Returns:
        `ok`, or how it ended instead, with the last line that it wrote.
    """
    port = _free_port(host)
    token = load_access_tokens(folder / ".flexcell" / "tokens").operator
    command = [sys.executable, "-c", _PROGRAM, "serve", "--host", host, "--port", str(port)]
    ended = Event()
    with (
        ThreadPoolExecutor(clients) as pool,
        subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as server,
    ):
        gate = Barrier(clients)
        asking = [pool.submit(_ask, (host, port), token, gate, ended) for _ in range(clients)]
        try:
            _wait(server, asking)
            answered = [each.done() and each.result() for each in asking]
        finally:
            ended.set()
            server.send_signal(signal.SIGTERM)
            last_line = server.communicate()[1].decode(errors="replace").strip().rpartition("\n")[2]
    if server.returncode < 0:
        return f"{signal.Signals(-server.returncode).name} {last_line}".strip()
    if not all(answered):
        return f"no answer, exit code {server.returncode} {last_line}".strip()
    return "ok"


def _wait(server: subprocess.Popen[bytes], asking: Sequence[Future[bool]]) -> None:
    """Return when every client has its answers, or the server has died, or nobody would wait any longer."""
    due_s = time.monotonic() + _GIVE_UP_S
    while wait(asking, timeout=0.05).not_done and server.poll() is None and time.monotonic() < due_s:
        continue


def _ask(address: tuple[str, int], token: str, gate: Barrier, ended: Event) -> bool:
    """Ask for every path a few times, over connections that begin anew; return whether all were answered."""
    gate.wait()
    return all(_answered(address, path, token, ended) for _ in range(_ROUNDS) for path in _PATHS)


def _answered(address: tuple[str, int], path: str, token: str, ended: Event) -> bool:
    while not ended.is_set():
        connection = http.client.HTTPConnection(*address, timeout=60)
        try:
            connection.request("GET", path, headers={"authorization": f"Bearer {token}"})
            answer = connection.getresponse()
            answer.read()
        except (OSError, http.client.HTTPException):
            ended.wait(0.005)  # it does not listen yet, or has died
            continue
        finally:
            connection.close()
        return answer.status < http.client.INTERNAL_SERVER_ERROR
    return False


def _free_port(host: str) -> int:
    with socket.socket() as probe:
        probe.bind((host, 0))
        return int(probe.getsockname()[1])


def main() -> None:
    """Run the starts and print what became of them."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    parser.add_argument("--starts", type=int, default=50, help="how often (default 50)")
    parser.add_argument("--clients", type=int, default=4, help="clients that reconnect meanwhile (default 4)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the counts to FILE")
    options = parser.parse_args()
    ends: Counter[str] = Counter()
    for number in range(1, options.starts + 1):
        with tempfile.TemporaryDirectory() as folder:
            new_project(Path(folder))
            ends[end := start_server_once(Path(folder), clients=options.clients)] += 1
        print(f"{number}: {end}", flush=True)
    print(f"{ends['ok']} of {options.starts} starts ended as they should, {os.cpu_count()} cores")
    if options.json:
        options.json.write_text(json.dumps(ends, indent=1) + "\n", encoding="utf-8")
    sys.exit(0 if ends["ok"] == options.starts else 1)


if __name__ == "__main__":
    main()
