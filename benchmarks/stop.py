"""How long STOP takes: `python -P -m benchmarks.stop [--trials N] [--paths page http cli signal] [--conditions …]`.

A real `flexcell serve` moves an arm; STOP is given by a click of the mouse on the page in Chromium, over the relay's
HTTP port, by `flexcell stop`, or by SIGINT, while the engine is free, its event loop blocked by a state (sleeping, or
holding the interpreter) or busy with the costliest expressions, 200 clients ask all the time, or the engine is
suspended or killed. Reported are the times until STOP is acknowledged (in the page: from the click until it says so)
and until the world's own process measures that everything is at rest (the arm is in mid-motion, at 0.4 of its speed).
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Generator
from contextlib import closing, contextmanager, nullcontext
from dataclasses import dataclass, field
from functools import partial
from http.client import HTTPConnection
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlsplit

import httpx
import numpy as np
from playwright.sync_api import Browser, Page, sync_playwright

from benchmarks.login_link import login_link
from benchmarks.stop_server import FLEXCELL, Server, server
from tests.editor_web.browsing import browser_program

_BLOCK_S = 0.6
_INTO_S = 0.03
CONDITIONS = ("free", "state", "interpreter", "expression", "clients", "suspended", "killed")
PATHS = ("page", "http", "cli", "signal")
# A suspended process gets no signal, and a killed one neither.
_SENSELESS = {("signal", "suspended"), ("signal", "killed")}
_HOW = {"state": "sleep", "interpreter": "hold", "expression": "expression"}
# Both as the page's own clock has them: what drives the browser takes longer than the page where all share two cores.
_LISTEN = """() => {
  const news = document.querySelector('[aria-label="State of the stop"]')
  const epochMs = (eventMs) => Date.now() - performance.now() + eventMs
  window.stopTimes = new Promise((resolve) => {
    let pressedMs
    const look = () => /acknowledged|at rest/.test(news.textContent) && resolve([pressedMs, epochMs(performance.now())])
    document.querySelector('[aria-label="Stop of the cell"] [aria-keyshortcuts]').addEventListener(
      'click', (click) => { pressedMs = epochMs(click.timeStamp) }, { once: true, capture: true })
    new MutationObserver(look).observe(news, { subtree: true, childList: true, characterData: true })
  })
}"""
_PUT_AWAY = """() => new Promise((gone) => {
  const look = () => document.querySelector('[aria-label="State of the stop"] > *') ? setTimeout(look, 5) : gone()
  document.querySelector('[aria-label="Put the words about the stop away"]')?.click()
  look()
})"""


class Press(NamedTuple):
    """When STOP was given and when it was acknowledged, on the monotonic clock."""

    pressed_s: float
    acknowledged_s: float


@dataclass(kw_only=True)
class Times:
    """What was measured of one path under one condition, in seconds from STOP."""

    path: str
    condition: str
    acknowledged_s: list[float] = field(default_factory=list[float])
    at_rest_s: list[float] = field(default_factory=list[float])


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=100)
    parser.add_argument("--paths", nargs="+", choices=PATHS, default=PATHS)
    parser.add_argument("--conditions", nargs="+", choices=CONDITIONS, default=CONDITIONS)
    options = parser.parse_args()
    print(f"{'path':8}{'engine is':14}{'n':>5}  {'acknowledged ms p50/p99/max':>30}  {'at rest ms p50/p99/max':>28}")
    for path in options.paths:
        for condition in options.conditions:
            if (path, condition) not in _SENSELESS:
                _print(_measure(path, condition, options.trials))


def _measure(path: str, condition: str, trials: int) -> Times:
    times = Times(path=path, condition=condition)
    ends = condition == "killed" or path == "signal"
    with tempfile.TemporaryDirectory() as folder, _browser() if path == "page" else nullcontext() as browser:
        if ends:
            for number in range(trials):
                with server(Path(folder) / str(number)) as running, _presser(path, running, browser) as press:
                    _trial(running, times, press)
        else:
            with server(Path(folder) / "one") as running, _presser(path, running, browser) as press:
                for _ in range(trials):
                    _trial(running, times, press)
                    running.signal(signal.SIGCONT)
                    running.wait_until_idle()
    return times


def _trial(running: Server, times: Times, press: Callable[[], Press]) -> None:
    with _clients(running) if times.condition == "clients" else nullcontext():
        running.start_run(_HOW.get(times.condition, "none"), _BLOCK_S)
        match times.condition:
            case "suspended":
                running.signal(signal.SIGSTOP)
            case "killed":
                running.signal(signal.SIGKILL)
            case _:
                pass
        time.sleep(_INTO_S)
        pressed = press()
        times.acknowledged_s.append(pressed.acknowledged_s - pressed.pressed_s)
        times.at_rest_s.append(max(0.0, running.resting_since_s() - pressed.pressed_s))


def _over_http(running: Server) -> float:
    # Not httpx, whose client reads all certificates of the machine before it sends anything.
    url = urlsplit(str(running.record["stop_url"]))
    connection = HTTPConnection(str(url.hostname), url.port, timeout=10.0)
    with closing(connection):
        connection.request("POST", url.path, json.dumps({"token": running.record["stop_token"], "reason": "benchmark"}))
        answer = connection.getresponse().read()
    written_s = time.monotonic()
    assert json.loads(answer)["acknowledged"], answer
    return written_s


def _by_command(running: Server) -> float:
    command = [FLEXCELL, "stop", "--state", running.state]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        line = process.stdout.readline()
        written_s = time.monotonic()
        process.communicate()
    assert line.startswith(b"STOP acknowledged"), line
    return written_s


def _by_signal(running: Server) -> float:
    log = running.folder / "log"
    before = log.stat().st_size
    running.signal(signal.SIGINT)
    while b"STOP acknowledged" not in log.read_bytes()[before:]:
        time.sleep(0.001)
    return time.monotonic()


@contextmanager
def _browser() -> Generator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=browser_program(), args=["--no-sandbox"])
        yield browser
        browser.close()


@contextmanager
def _presser(path: str, running: Server, browser: Browser | None) -> Generator[Callable[[], Press]]:
    """Give what gives STOP in this way."""
    if browser is None:
        yield lambda: Press(time.monotonic(), _ACKNOWLEDGED[path](running))
        return
    page = browser.new_page(locale="en-US")
    try:
        page.goto(login_link(running.record["url"], running.record["token"]))
        button = page.get_by_role("button", name="Stop the cell")
        button.wait_for()
        box = button.bounding_box()
        assert box is not None
        yield partial(_in_page, page, box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    finally:
        page.close()


def _in_page(page: Page, x: float, y: float) -> Press:
    page.evaluate(_LISTEN)
    to_monotonic_s = time.monotonic() - time.time()
    page.mouse.click(x, y)
    pressed_ms, acknowledged_ms = page.evaluate("() => window.stopTimes")
    page.evaluate(_PUT_AWAY)
    return Press(1e-3 * pressed_ms + to_monotonic_s, 1e-3 * acknowledged_ms + to_monotonic_s)


_ACKNOWLEDGED: dict[str, Callable[[Server], float]] = {
    "http": _over_http,
    "cli": _by_command,
    "signal": _by_signal,
}


@contextmanager
def _clients(running: Server) -> Generator[None]:
    url = httpx.URL(running.record["url"])
    command = [sys.executable, "-m", "benchmarks.stop_clients", url.host, str(url.port), running.record["token"]]
    process = subprocess.Popen(command, env=dict(os.environ), stderr=subprocess.DEVNULL)
    try:
        yield
    finally:
        process.kill()
        process.wait()


def _print(times: Times) -> None:
    columns = [_row(times.acknowledged_s), _row(times.at_rest_s)]
    count = len(times.acknowledged_s)
    print(f"{times.path:8}{times.condition:14}{count:5}  {columns[0]:>30}  {columns[1]:>28}", flush=True)


def _row(values_s: list[float]) -> str:
    p50, p99 = np.percentile(values_s, (50, 99)) * 1000.0
    return f"{p50:.0f} / {p99:.0f} / {max(values_s) * 1000.0:.0f}"


if __name__ == "__main__":
    main()
