"""The `flexcell` command with its imports done: forks for each line on stdin, `{args, cwd, env, in, out, err}` in JSON.

Each command runs in a process of its own, from its arguments to its exit code, which is told on stdout; only the
seconds that Python takes to import are not spent again. The installed script is run by
`tests/engine/cli/commands/test_run.py`.
"""

from __future__ import annotations

import gc
import importlib
import json
import os
import pkgutil
import sys
import threading
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from typer.testing import CliRunner

import engine.cli
from engine.cli.main import app, main
from engine.registry import load_states

# A server is a program of its own, and brings the web with it.
_NOT_HERE = ("engine.cli.commands.serve", "engine.cli.entry")
# What sweeps load with their first use: scipy takes a second.
_LATER = ("engine.sweep.design.designs", "engine.sweep.summary", "engine.sweep.sweep_execution")


def serve() -> None:
    """Fork until stdin ends; in a child, run the command and return."""
    for module in pkgutil.walk_packages(engine.cli.__path__, "engine.cli."):
        if module.name not in _NOT_HERE:
            importlib.import_module(module.name)
    for name in _LATER:
        importlib.import_module(name)
    load_states()
    # Typer loads half of itself with the first command, and what prints help with the first help.
    CliRunner().invoke(app, ["runs", "--help"])
    assert threading.active_count() == 1, "a thread would not be in the child"
    gc.freeze()
    _write_line("ready")
    for line in sys.stdin:
        pid = os.fork()
        if pid == 0:
            _become(json.loads(line))
            main()
            return
        _write_line(str(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])))


def _write_line(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def _become(request: dict[str, Any]) -> None:
    for number, path in enumerate((os.devnull, request["out"], request["err"])):
        opened = os.open(path, os.O_WRONLY if number else os.O_RDONLY)
        os.dup2(opened, number)
        os.close(opened)
    if request["in"] is not None:
        # A pipe, as from a terminal's `|`; it holds 64 KiB.
        reading, writing = os.pipe()
        os.write(writing, request["in"].encode())
        os.close(writing)
        os.dup2(reading, 0)
        os.close(reading)
    os.environ.clear()
    os.environ.update(request["env"])
    os.chdir(request["cwd"])
    sys.argv = ["flexcell", *request["args"]]
    # The name in the help is that of a script, not of this module.
    sys.modules["__main__"].__package__ = ""


if __name__ == "__main__":
    serve()
