"""Robot Web Services of the emulated controller: HTTP 1.1 with digest authentication on one port."""

from __future__ import annotations

import asyncio
import hashlib
import re
import secrets
from collections.abc import Mapping
from urllib.parse import parse_qsl, unquote, urlsplit

import msgspec

from robots.drivers.abb.emulation.controller_panel import PanelRefusal
from robots.drivers.abb.emulation.rws_resources import NoSuchResource, RwsResources
from robots.drivers.emulation.tcp_server import TcpServer
from robots.drivers.emulation.wire_faults import WireFaults, spoil

_REALM = "validusers@robapi.abb"
_MOST_BODY = 1 << 16
_PARTS = re.compile(r'(\w+)=(?:"([^"]*)"|([^\s,]+))')
_REASONS = {200: "OK", 204: "No Content", 400: "Bad Request", 401: "Unauthorized", 404: "Not Found", 503: "Busy"}


class RwsServer(TcpServer):
    """Serves any number of clients; `faults` are those of the whole controller, `own_faults` of this port alone.

    Args:
        resources: Answers.
        faults: Of the wire of the controller.
        host: Where to listen.
        port: 0 for a free one.
        user: Who may ask.
        password: Of the user.
    """

    def __init__(
        self, resources: RwsResources, faults: WireFaults, *, host: str, port: int, user: str, password: str
    ) -> None:
        super().__init__(host=host, port=port)
        self._resources = resources
        self._faults = faults
        self.own_faults = WireFaults()
        self._user = user
        self._key = _md5(f"{user}:{_REALM}:{password}")
        self._nonce = secrets.token_hex(16)
        self.requests = 0
        """Number of authenticated requests."""

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer the requests of a client."""
        try:
            while head := await reader.readuntil(b"\r\n\r\n"):
                length = int(_head(head)[1].get("content-length", "0"))
                if not 0 <= length <= _MOST_BODY:
                    break
                self._deliver(self.answer(head, await reader.readexactly(length)), writer)
        except (asyncio.IncompleteReadError, asyncio.LimitOverrunError, ValueError):
            pass  # the client has gone, or speaks something else

    def _deliver(self, reply: bytes, writer: asyncio.StreamWriter) -> None:
        faults, own = self._faults, self.own_faults
        if faults.cut or own.cut or faults.frozen or own.frozen:
            return
        reply = spoil(reply) if faults.garbage or own.garbage else reply
        late_s = max(faults.slow_s, own.slow_s)
        asyncio.get_running_loop().call_later(late_s, writer.write, reply)

    def answer(self, head: bytes, body: bytes) -> bytes:
        """Return the answer to a request; raises ValueError for what is none."""
        first, headers = _head(head)
        method, target, *_ = (*first.split(" "), "", "")
        url = urlsplit(target)
        if not self._is_authentic(method, target, headers.get("authorization", "")):
            challenge = f'Digest realm="{_REALM}", qop="auth", nonce="{self._nonce}", algorithm=MD5'
            return _response(401, b"", {"WWW-Authenticate": challenge})
        self.requests += 1
        if self.own_faults.refuse:
            return _response(503, b"")
        path, query = unquote(url.path), dict(parse_qsl(url.query))
        try:
            if path == "/logout":
                return _response(200, b"")
            if method == "POST":
                self._resources.act(path, query.get("action", ""), dict(parse_qsl(body.decode("latin-1"))))
                return _response(204, b"")
            states = self._resources.read(path)
        except NoSuchResource as error:
            return _response(404, _status(f"no such resource: {error}", -1073445859))
        except PanelRefusal as error:
            return _response(400, _status(str(error), -1073445865))
        return _response(200, msgspec.json.encode({"_links": {}, "_embedded": {"_state": states}}))

    def _is_authentic(self, method: str, target: str, header: str) -> bool:
        given = {name: quoted or bare for name, quoted, bare in _PARTS.findall(header)}
        if given.get("username") != self._user or given.get("nonce") != self._nonce or given.get("uri") != target:
            return False
        request = _md5(f"{method}:{target}")
        middle = ":".join(given.get(part, "") for part in ("nonce", "nc", "cnonce", "qop"))
        expected = _md5(f"{self._key}:{middle}:{request}")
        return secrets.compare_digest(given.get("response", "").encode(), expected.encode())


def _head(head: bytes) -> tuple[str, dict[str, str]]:
    first, *lines = head.decode("latin-1").split("\r\n")
    pairs = (line.partition(":") for line in lines if line)
    return first, {name.strip().lower(): value.strip() for name, _, value in pairs}


def _status(message: str, code: int) -> bytes:
    return msgspec.json.encode({"_embedded": {"status": {"code": str(code), "msg": message}}})


def _response(code: int, body: bytes, headers: Mapping[str, str] | None = None) -> bytes:
    lines = [f"HTTP/1.1 {code} {_REASONS[code]}", "Content-Type: application/json", f"Content-Length: {len(body)}"]
    lines += [f"{name}: {value}" for name, value in (headers or {}).items()]
    if code == 200:
        lines.append("Set-Cookie: -http-session-=1::http.session::emulated; path=/; httponly")
    return ("\r\n".join(lines) + "\r\n\r\n").encode("latin-1") + body


def _md5(text: str) -> str:
    # Digest authentication of the controller is MD5.
    return hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()
