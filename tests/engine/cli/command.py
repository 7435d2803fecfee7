"""Runs the `flexcell` command as a user would, in a process that has its imports behind it."""

from __future__ import annotations

import atexit
import json
import os
import select
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

FLEXCELL = Path(sys.executable).with_name("flexcell")
_ROOT = Path(__file__).parents[3]
_LONGEST_S = 100.0


@dataclass(frozen=True)
class CommandOutput:
    """What the command printed and its exit code."""

    code: int
    out: str
    err: str


def flexcell(*arguments: str | Path, cwd: Path, stdin: str | None = None) -> CommandOutput:
    """Run the command to its end; what it is given on standard input ends after this text."""
    # Of those that wait, or a new one: tests may run two commands at a time, in threads.
    preloaded = _IDLE.pop() if _IDLE else _Preloaded()
    said = preloaded.run([str(each) for each in arguments], cwd, stdin)
    _IDLE.append(preloaded)
    return said


class _Preloaded:
    """One process that forks for each command; see `preloaded.py`."""

    def __init__(self) -> None:
        command = [sys.executable, "-P", "-m", "tests.engine.cli.preloaded"]
        environment = {**os.environ, "PYTHONPATH": str(_ROOT)}
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment, start_new_session=True
        )
        atexit.register(self._process.kill)
        assert self._line() == "ready"

    def run(self, arguments: list[str], cwd: Path, stdin: str | None) -> CommandOutput:
        """Run one command; raises TimeoutExpired."""
        with tempfile.NamedTemporaryFile() as out, tempfile.NamedTemporaryFile() as err:
            asked = {
                "args": arguments,
                "cwd": str(cwd),
                "env": dict(os.environ),
                "in": stdin,
                "out": out.name,
                "err": err.name,
            }
            assert self._process.stdin is not None
            self._process.stdin.write(f"{json.dumps(asked)}\n")
            self._process.stdin.flush()
            code = int(self._line(arguments))
            return CommandOutput(code, out.read().decode(), err.read().decode())

    def _line(self, arguments: list[str] | None = None) -> str:
        pipe = self._process.stdout
        assert pipe is not None
        if not select.select([pipe], [], [], _LONGEST_S)[0]:
            os.killpg(self._process.pid, 9)
            raise subprocess.TimeoutExpired(["flexcell", *(arguments or ())], _LONGEST_S)
        return pipe.readline().strip()


_IDLE: list[_Preloaded] = []
