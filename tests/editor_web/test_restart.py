"""The server is killed and started again, the browser is killed, the wire is cut: each side notices, and says so."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import threading
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Self

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from editor_web.security.authentication import OPERATOR
from editor_web.sockets import live_stream as live_route
from engine.event import OperatorChanged
from engine.runtime.control.control import LossPolicy
from engine.runtime.run_options import RunOptions
from tests.editor_web.browsing import browser_program, opened_page, require_accessible, switch
from tests.editor_web.real_server import dashboard_of
from tests.editor_web.workshop import NAP, NAP_ID, Workshop
from tests.engine.cli.process import entered, started, until


def node(page: Page, path: str) -> Locator:
    """A node of the graph."""
    return page.locator(f".react-flow__node[data-id='{path}'] [data-node]")


def test_a_killed_server_is_missed_found_again_and_its_run_goes_on(
    browser: Browser, tmp_path: Path, loopback: str
) -> None:
    """Nothing can be pressed meanwhile; afterwards the run is offered with its question, and resumed from the page."""
    (tmp_path / "behaviors").mkdir()
    (tmp_path / NAP_ID).write_text(NAP, encoding="utf-8")
    with started("serve", "--host", loopback, "--port", "0", cwd=tmp_path) as first:
        served = dashboard_of(first, tmp_path / ".flexcell")
        with opened_page(browser, served, f"/behaviors/{NAP_ID}", quiet=False) as page:
            page.get_by_role("button", name="Start").click()
            expect(node(page, "root/only")).to_have_attribute("data-status", "active")
            until(first, tmp_path, entered("root/only"))
            first.kill()
            expect(page.get_by_role("alert")).to_contain_text("The server does not answer")
            for name in ("Stop this run", "Start"):
                expect(page.get_by_role("button", name=name, exact=True)).to_be_disabled()
            expect(page.get_by_role("button", name="Stop the cell")).to_be_enabled()
            for name in ("Pause", "Take control"):
                expect(page.get_by_role("button", name=name, exact=True)).to_have_attribute("aria-disabled", "true")
            with started("serve", "--host", loopback, "--port", str(served.port), cwd=tmp_path) as second:
                dashboard_of(second, tmp_path / ".flexcell")
                expect(page.get_by_role("alert")).to_have_count(0)
                expect(page.get_by_role("status", name="State of the run")).to_have_text("No run")
                expect(page.get_by_role("button", name="Stop this run")).to_have_count(0)
                expect(node(page, "root/only")).to_have_attribute("data-status", "idle")
                offered = page.get_by_role("listitem", name="Interrupted run of nap")
                expect(offered).to_contain_text("its engine ended in the middle of it")
                offered.get_by_role("button", name="Resume").click()
                switch(offered.get_by_role("radiogroup", name="root/only").get_by_label("Run it again"))
                require_accessible(page, "an interrupted run above its behavior")
                offered.get_by_role("button", name="Go on with these answers").click()
                expect(offered).to_have_count(0)
                expect(node(page, "root/only")).to_have_attribute("data-status", "active")
                page.get_by_role("tab", name="Log").click()
                expect(page.get_by_role("log")).to_contain_text("resumed after event")
                page.get_by_role("button", name="Stop this run").click()
                expect(page.get_by_role("status", name="State of the run")).to_have_text("Stopped")


@contextmanager
def killable_browser(like: Browser, folder: Path) -> Generator[tuple[Browser, Callable[[], None]]]:
    """A browser that is a process of ours, and how it is killed."""
    command = [
        browser_program(),
        "--headless=new",
        "--no-sandbox",
        "--no-first-run",
        "--remote-debugging-port=0",
        f"--user-data-dir={folder}",
        "about:blank",
    ]
    with subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        assert process.stderr is not None

        def kill() -> None:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)

        try:
            found = next(line for line in process.stderr if line.startswith("DevTools listening on "))
            yield like.browser_type.connect_over_cdp(found.split()[-1]), kill
        finally:
            kill()


@pytest.mark.parametrize(
    ("policy", "done", "said"),
    [("hold", "Paused", "operator lost"), ("stop", "", "stop requested: the operator was lost")],
)
def test_a_killed_browser_is_an_operator_lost_and_another_takes_over(
    browser: Browser, tmp_path: Path, shop: Workshop, policy: LossPolicy, done: str, said: str
) -> None:
    """The run is paused or stopped after its time, the log says why, and the second browser operates it."""
    run = shop.start(supervision=RunOptions(loss_policy=policy, loss_timeout_s=0.3))
    with opened_page(browser, shop.running, f"/runs/{run}") as second:
        with killable_browser(browser, tmp_path / "profile") as (doomed, kill):
            first = doomed.new_context().new_page()
            first.goto(shop.running.new_login_url())
            first.goto(f"{shop.running.url}runs/{run}")
            first.get_by_role("button", name="Take control", exact=True).click()
            expect(first.get_by_text("You operate this run. If this page is lost, 0.3 s later")).to_be_visible()
            expect(second.get_by_text("Another page or console operates this run.")).to_be_visible()
            kill()
            expect(second.get_by_role("log")).to_contain_text(said)
        if policy == "stop":
            expect(second.get_by_role("status", name="State of the run")).to_have_text("Stopped")
            return
        expect(second.get_by_role("status", name="State of the run")).to_have_text(done)
        expect(second.get_by_text("The operator was lost: 0.3 s later the run is paused")).to_be_visible()
        second.get_by_role("button", name="Take control", exact=True).click()
        expect(second.get_by_text("You operate this run.")).to_be_visible()
        second.get_by_role("button", name="Resume", exact=True).click()
        expect(second.get_by_role("status", name="State of the run")).to_have_text("Running")


class Wire:
    """`with Wire(host, port) as wire`: the server at 127.0.0.1 too, until the wire is cut: both ends stay open."""

    def __init__(self, host: str, port: int) -> None:
        self._server = (host, port)
        self._whole = threading.Event()
        self._whole.set()
        self._listener = socket.create_server(("127.0.0.1", port))
        self._open: list[socket.socket] = []
        self._dead: set[socket.socket] = set()

    def cut(self) -> None:
        """Let nothing pass any more; nobody is told."""
        self._dead |= set(self._open)
        self._whole.clear()

    def restore(self) -> None:
        """Let new connections pass; those that were cut stay so."""
        self._whole.set()

    def __enter__(self) -> Self:
        threading.Thread(target=self._accept, name="wire", daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        for each in (self._listener, *self._open):
            each.close()

    def _accept(self) -> None:
        while True:
            try:
                near, _ = self._listener.accept()
            except OSError:
                return  # closed
            far = socket.create_connection(self._server)
            self._open += [near, far]
            if not self._whole.is_set():
                self._dead |= {near, far}
            for one, other in ((near, far), (far, near)):
                threading.Thread(target=self._pass, args=(one, other), name="wire", daemon=True).start()

    def _pass(self, one: socket.socket, other: socket.socket) -> None:
        try:
            while data := one.recv(65536):
                if one in self._dead:
                    return
                other.sendall(data)
            other.shutdown(socket.SHUT_WR)
        except OSError:
            return  # either end was closed


def test_a_cut_wire_is_noticed_on_both_sides(
    browser: Browser, shop: Workshop, loopback: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both sockets stay open, yet the page says so after 12 s of silence, and the run has lost its operator."""
    monkeypatch.setattr(live_route, "PING_S", 0.1)
    # Longer than a page that is there takes for its answer, much shorter than the 12 s of the page.
    monkeypatch.setattr(live_route, "SILENCE_S", 2.0)
    run = shop.start(supervision=RunOptions(loss_policy="hold", loss_timeout_s=0.1))
    port = shop.running.port
    with Wire(loopback, port) as wire, opened_page(browser, shop.running, f"/runs/{run}") as watching:
        context = browser.new_context()
        page = context.new_page()
        page.clock.install()
        through = f"http://127.0.0.1:{port}/"
        page.goto(f"{through}login?t={shop.running.sessions.new_link(OPERATOR)}")
        page.goto(f"{through}runs/{run}")
        page.get_by_role("button", name="Take control", exact=True).click()
        expect(page.get_by_text("You operate this run.")).to_be_visible()
        wire.cut()
        expect(watching.get_by_role("log")).to_contain_text("operator lost")
        expect(watching.get_by_role("status", name="State of the run")).to_have_text("Paused")
        expect(page.get_by_role("alert")).to_have_count(0)
        page.clock.fast_forward(12_000)
        expect(page.get_by_role("alert")).to_contain_text("The server does not answer")
        wire.restore()
        page.clock.fast_forward(5_000)
        expect(page.get_by_role("alert")).to_have_count(0)
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Paused")
        expect(page.get_by_text("You operate this run.")).to_be_visible()
        context.close()
    changes = [event.status for event in shop.events(run) if isinstance(event, OperatorChanged)]
    assert changes[:3] == ["attached", "lost", "attached"]
