"""A stand-in for the stop process of a server: it answers as that one does, and counts what it is asked."""

from __future__ import annotations

import json
import threading
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, Self

from playwright.sync_api import Locator, Page, Route, expect

from tests.editor_web.browsing import fetched


@dataclass(frozen=True, kw_only=True)
class Asked:
    """One request."""

    method: str
    path: str
    content_type: str
    body: dict[str, Any]


@dataclass(kw_only=True)
class StopProcess:
    """`with StopProcess(host=…, origin=…) as stop`: `at_rest` and `engine` are what it answers from then on."""

    host: str
    origin: str
    at_rest: bool = True
    engine: str = "silent"
    token: str = "stop-token"
    asked: list[Asked] = field(default_factory=list[Asked])
    answers: threading.Event = field(default_factory=threading.Event)
    """Cleared, it answers nobody until it is set again."""
    _server: ThreadingHTTPServer | None = None

    @property
    def channel(self) -> dict[str, str]:
        """What the session tells an operator of it."""
        assert self._server is not None
        return {"url": f"http://{self.host}:{self._server.server_port}/stop", "token": self.token}

    def stops(self) -> list[Asked]:
        """The requests to stop, without those for the state of one."""
        return [each for each in self.asked if each.path == "/stop"]

    def end(self) -> None:
        """Answer nobody any more."""
        if self._server is not None:
            self._server.shutdown()
            self._server.server_close()
            self._server = None

    def __enter__(self) -> Self:
        self.answers.set()
        self._server = ThreadingHTTPServer((self.host, 0), self._handler())
        threading.Thread(target=self._server.serve_forever, name="stop", daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    def _answer(self) -> bytes:
        device = {"name": "world", "acknowledged": True, "at_rest": self.at_rest}
        count = len(self.stops())
        return json.dumps({"stop": count, "acknowledged": True, "devices": [device], "engine": self.engine}).encode()

    def _handler(self) -> type[BaseHTTPRequestHandler]:
        stop = self

        class Handler(BaseHTTPRequestHandler):
            def _take(self) -> None:
                body = self.rfile.read(int(self.headers.get("Content-Length", "0")))
                content_type = self.headers.get("Content-Type", "")
                asked = Asked(
                    method=self.command, path=self.path, content_type=content_type, body=json.loads(body or b"{}")
                )
                stop.asked.append(asked)
                stop.answers.wait()
                self.send_response(200 if asked.body.get("token") == stop.token else 403)
                self.send_header("Access-Control-Allow-Origin", stop.origin)
                self.end_headers()
                self.wfile.write(stop._answer())

            do_POST = _take  # noqa: N815 - the library finds it by this name
            do_OPTIONS = _take  # noqa: N815 - the same

            def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the library's name
                """Say nothing."""

        return Handler


def connect_stop(page: Page, stop: StopProcess) -> None:
    """Let the page of an operator know the stop process, as its server will: in the session and in its policy."""

    def session(route: Route) -> None:
        told = fetched(route)
        if told.ok and (body := told.json())["role"] == "operator":
            route.fulfill(response=told, json={**body, "stop": stop.channel})
        else:
            route.fulfill(response=told)

    # A document that a test fulfills is of no address space, and Chromium lets it reach no loopback port.
    session_of_browser = page.context.new_cdp_session(page)
    session_of_browser.send("Page.setBypassCSP", {"enabled": True})  # pyright: ignore[reportUnknownMemberType]
    page.route("**/api/v1/session", session)
    page.reload()
    # It stands there once the page knows its session, which it keeps from then on.
    expect(stop_button(page)).to_be_visible()
    page.unroute_all(behavior="wait")


def stop_button(page: Page) -> Locator:
    """STOP of the cell."""
    return page.get_by_role("button", name="Stop the cell")


def stop_status(page: Page) -> Locator:
    """State of the stop."""
    return page.get_by_role("status", name="State of the stop")
