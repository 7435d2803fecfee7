"""`flexcell serve` of a checkout for programs that operate its page."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[1]
_LOGIN = re.compile(r"http://\S+/login\?t=\S+")
_PROGRAM = "import sys; from engine.cli.entry import main; sys.argv[0] = 'flexcell'; sys.exit(main())"
_LIMIT_S = 60.0


@contextmanager
def served_dashboard(project: Path, state: Path, *, cell: Path | None = None, tree: Path = ROOT) -> Generator[str]:
    """Serve a project on a free port until the block ends; gives the address that logs in.

    Args:
        project: Folder that contains `behaviors/`.
        state: Folder for the state of the server.
        cell: The cell to connect; None for none.
        tree: The checkout whose code is served.

    Raises:
        SystemExit: the server ended before it printed its address.
    """
    command = [sys.executable, "-c", _PROGRAM, "serve", "--port", "0", "--project", project, "--state", state]
    command += [] if cell is None else ["--cell", cell]
    environment = {**os.environ, "PYTHONPATH": str(tree)}
    server = subprocess.Popen(command, cwd=tree, env=environment, stdout=subprocess.PIPE, text=True)
    try:
        assert server.stdout is not None
        found = next((match for line in server.stdout if (match := _LOGIN.search(line))), None)
        if found is None:
            raise SystemExit("flexcell serve ended without printing its address")
        yield found.group()
    finally:
        server.terminate()
        server.wait(timeout=_LIMIT_S)
