"""Where a `flexcell serve` in a process of its own has its page."""

from __future__ import annotations

import subprocess
from pathlib import Path

from editor_web.security.authentication import OPERATOR, Role
from editor_web.security.login_sessions import LoginSessions
from editor_web.server import Dashboard
from engine.bus.remote_bus import ServerRecord
from engine.cli.commands.login import new_login_url


class ServerProcess(Dashboard):
    """A dashboard whose log-in links are made by the process that serves it."""

    def new_login_url(self, role: Role = OPERATOR) -> str:
        """Ask the server, as `flexcell login` does."""
        return new_login_url(ServerRecord(url=self.url, token=self.token, pid=0), role=role)


def dashboard_of(process: subprocess.Popen[str], folder: Path) -> Dashboard:
    """Where a `flexcell serve` that keeps its state in `folder` says that its page is."""
    assert process.stdout is not None
    line = process.stdout.readline()
    assert "/login?t=" in line, (line, process.poll())
    record = ServerRecord.read(folder)
    port = int(record.url.rstrip("/").rsplit(":", 1)[1])
    sessions = LoginSessions(file=None, tokens="")
    return ServerProcess(url=record.url, token=record.token, port=port, view_port=None, sessions=sessions)
