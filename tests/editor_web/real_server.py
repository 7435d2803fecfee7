"""Where a `flexcell serve` in a process of its own has its page."""

from __future__ import annotations

import subprocess

from editor_web.server import Dashboard


def dashboard_of(process: subprocess.Popen[str]) -> Dashboard:
    """Where a `flexcell serve` says that its page is."""
    assert process.stdout is not None
    line = process.stdout.readline()
    login = line.removeprefix("Dashboard: ").strip()
    assert "/login?t=" in login, (line, process.poll())
    url, token = login.split("login?t=")
    return Dashboard(url=url, login_url=login, token=token, port=int(url.rstrip("/").rsplit(":", 1)[1]))
