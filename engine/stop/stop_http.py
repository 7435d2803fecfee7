"""STOP over HTTP: POST /stop and POST /stop/status, served regardless of other connections."""

from __future__ import annotations

import asyncio
import hmac
from collections import OrderedDict
from collections.abc import Awaitable, Callable

import h11
import msgspec

from engine.stop.dispatcher import StopDispatcher
from engine.stop.relay_messages import MAX_REASON, StopStatus

MAX_CONNECTIONS = 256
MAX_BODY = 4096
REQUEST_S = 2.0
_DEFAULT_REASON = "stopped by the operator"


class StopRequest(msgspec.Struct, frozen=True, kw_only=True):
    """A request: JSON with any content type, so that a page needs no CORS preflight."""

    token: str
    reason: str = _DEFAULT_REASON


class _Refused(Exception):
    def __init__(self, status: int, message: str) -> None:
        super().__init__(message)
        self.status = status
        self.message = message


def new_http_protocol(dispatcher: StopDispatcher) -> Callable[[], asyncio.Protocol]:
    """Return a protocol factory for a server; its protocols share a limit on the number of connections."""
    connections: OrderedDict[_Http, None] = OrderedDict()
    return lambda: _Http(dispatcher, connections)


class _Http(asyncio.Protocol):
    """One connection, one request. Above the limit the oldest connection is aborted: a flood delays no STOP."""

    def __init__(self, dispatcher: StopDispatcher, connections: OrderedDict[_Http, None]) -> None:
        self._dispatcher = dispatcher
        self._connections = connections
        self._http = h11.Connection(h11.SERVER, max_incomplete_event_size=8192)
        self._request: h11.Request | None = None
        self._body = bytearray()
        self._transport: asyncio.Transport | None = None
        self._limit: asyncio.TimerHandle | None = None
        self._task: asyncio.Task[None] | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport
        self._limit = asyncio.get_running_loop().call_later(REQUEST_S, transport.abort)
        self._connections[self] = None
        if len(self._connections) > MAX_CONNECTIONS:
            oldest = next(iter(self._connections))
            oldest.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        self._connections.pop(self, None)
        if self._limit is not None:
            self._limit.cancel()

    def abort(self) -> None:
        """Close the connection at once."""
        self._connections.pop(self, None)
        if self._transport is not None:
            self._transport.abort()

    def data_received(self, data: bytes) -> None:
        if self._task is not None:
            return
        try:
            self._http.receive_data(data)
            if self._is_complete():
                self._task = asyncio.get_running_loop().create_task(self._answer())
        except h11.RemoteProtocolError as error:
            self._send(error.error_status_hint, {"message": "this is not an HTTP request"})
        except _Refused as refusal:
            self._send(refusal.status, {"message": refusal.message})

    def _is_complete(self) -> bool:
        while True:
            event = self._http.next_event()
            match event:
                case h11.Request():
                    self._request = event
                case h11.Data():
                    self._body += event.data
                    if len(self._body) > MAX_BODY:
                        raise _Refused(413, f"a request has at most {MAX_BODY} bytes")
                case h11.EndOfMessage():
                    return True
                case _:
                    return False

    async def _answer(self) -> None:
        try:
            answer = await self._action()
        except _Refused as refusal:
            self._send(refusal.status, {"message": refusal.message})
        else:
            self._send(200, answer)

    def _action(self) -> Awaitable[StopStatus]:
        request = self._request
        assert request is not None
        if request.method != b"POST":
            raise _Refused(405, "use the method POST")
        origin = self._header(b"origin")
        if origin and origin not in self._dispatcher.origins:
            raise _Refused(403, "requests from pages of other origins are refused")
        body = self._read_body()
        match request.target:
            case b"/stop":
                return self._dispatcher.stopped(body.reason[:MAX_REASON])
            case b"/stop/status":
                return self._status()
            case _:
                raise _Refused(404, "no such path: use /stop or /stop/status")

    async def _status(self) -> StopStatus:
        return self._dispatcher.status()

    def _read_body(self) -> StopRequest:
        scheme, _, bearer = self._header(b"authorization").partition(" ")
        try:
            if scheme.lower() == "bearer":
                fields = msgspec.json.decode(bytes(self._body) or b"{}", type=dict[str, object])
                body = msgspec.convert({**fields, "token": bearer.strip()}, StopRequest)
            else:
                body = msgspec.json.decode(bytes(self._body), type=StopRequest)
        except (msgspec.DecodeError, RecursionError) as error:
            raise _Refused(400, 'the body must be {"token": …, "reason": …}') from error
        if not (self._dispatcher.token and hmac.compare_digest(body.token.encode(), self._dispatcher.token.encode())):
            raise _Refused(401, "the token is not valid for this cell: see stop_token in the server's server.json")
        return body

    def _header(self, name: bytes) -> str:
        assert self._request is not None
        values = [value.decode("latin-1") for key, value in self._request.headers if key == name]
        return values[0] if len(values) == 1 else ""

    def _send(self, status: int, body: StopStatus | dict[str, str]) -> None:
        """Send the response and close; the connection may already be closed."""
        if self._transport is None or self._transport.is_closing():
            return
        payload = msgspec.json.encode(body)
        headers = [("content-type", "application/json"), ("content-length", str(len(payload)))]
        headers += [("cache-control", "no-store"), ("x-content-type-options", "nosniff"), ("connection", "close")]
        origin = self._header(b"origin") if self._request is not None else ""
        if origin and origin in self._dispatcher.origins:
            headers += [("access-control-allow-origin", origin), ("vary", "origin")]
        try:
            head = self._http.send(h11.Response(status_code=status, headers=headers)) or b""
            data = self._http.send(h11.Data(data=payload)) or b""
        except h11.LocalProtocolError:
            self._transport.abort()
            return
        self._transport.write(head + data)
        self._transport.close()
