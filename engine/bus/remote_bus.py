"""The bus of a running server, accessed over HTTP with the operator's token."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, Self

import httpx
import msgspec

from engine.bus.action import GoalHandle
from engine.bus.bus import BusEntry
from engine.errors import BusError, Cause
from engine.host.state_folder_names import SERVER_FILE
from engine.skills.goal_end import GoalEnd, GoalStatus


class ServerRecord(msgspec.Struct, frozen=True, kw_only=True):
    """The addresses and tokens of a server; readable by its owner only, as the token commands the cell."""

    url: str
    token: str
    pid: int
    stop_url: str = ""
    """The address of the stop relay, independent of the server; empty when there is none."""
    stop_token: str = ""

    @classmethod
    def read(cls, folder: Path) -> ServerRecord:
        """Return the record of the server with the state folder `folder`.

        Raises:
            BusError: no server runs there.
        """
        file = server_file(folder)
        try:
            return msgspec.json.decode(file.read_bytes(), type=ServerRecord)
        except (OSError, msgspec.DecodeError) as error:
            raise BusError(
                "no server runs here", where=file, hint="start one with `flexcell serve`, or give --cell FILE"
            ) from error


def server_file(folder: Path) -> Path:
    """Return the path of the server record in a state folder."""
    return folder / SERVER_FILE


class _Failure(msgspec.Struct):
    message: str = ""
    where: str | None = None
    hint: str | None = None


class _End(msgspec.Struct):
    status: str
    result: Any
    cause: Cause | None


@asynccontextmanager
async def server_client(folder: Path) -> AsyncGenerator[httpx.AsyncClient]:
    """Connect to the server with the state folder `folder` as its operator.

    Raises:
        BusError: no server runs there, or it does not answer.
    """
    record = ServerRecord.read(folder)
    headers = {"Authorization": f"Bearer {record.token}"}
    async with httpx.AsyncClient(base_url=record.url, headers=headers, timeout=10.0, trust_env=False) as client:
        try:
            yield client
        except httpx.TransportError as error:
            raise BusError(
                f"the server does not answer: {error}", where=record.url, hint="start it with `flexcell serve`"
            ) from error


class RemoteJsonBus:
    """A bus behind a server; create it with `connect`."""

    def __init__(self, client: httpx.AsyncClient) -> None:
        self._client = client

    @classmethod
    @asynccontextmanager
    async def connect(cls, folder: Path) -> AsyncGenerator[Self]:
        """Connect to the server with the state folder `folder`.

        Raises:
            BusError: no server runs there.
        """
        async with server_client(folder) as client:
            yield cls(client)

    async def listing(self) -> tuple[BusEntry, ...]:
        """Return everything on the bus."""
        response = await self._client.get("/api/v1/bus")
        return msgspec.json.decode(verify_response(response).content, type=tuple[BusEntry, ...])

    async def echo(self, topic: str) -> AsyncGenerator[str, None]:
        """Yield the messages of a topic as JSON, first the latest one."""
        async with self._client.stream("GET", "/api/v1/bus/echo", params={"topic": topic}, timeout=None) as response:
            if not response.is_success:
                await response.aread()
            verify_response(response)
            async for line in response.aiter_lines():
                if line:
                    yield line

    async def publish(self, topic: str, message: object) -> None:
        """Publish a message on a command topic."""
        body = {"topic": topic, "message": message}
        verify_response(await self._client.post("/api/v1/bus/publish", json=body))

    async def call(self, address: str, request: object) -> str:
        """Call a service and return its response as JSON."""
        body = {"address": address, "request": request}
        return verify_response(await self._client.post("/api/v1/bus/call", json=body)).text

    async def perform(
        self, address: str, goal: object, *, on_sent: Callable[[GoalHandle[Any, Any]], None] | None = None
    ) -> GoalEnd[Any]:
        """Send a goal and wait for its end; the server cancels the goal when the connection is lost."""
        body = {"address": address, "request": goal}
        response = verify_response(await self._client.post("/api/v1/bus/goal", json=body, timeout=None))
        end = msgspec.json.decode(response.content, type=_End)
        return GoalEnd(GoalStatus(end.status), end.result, end.cause)


def verify_response(response: httpx.Response) -> httpx.Response:
    """Return a response of the server; raise its refusal as `BusError`."""
    if response.is_success:
        return response
    try:
        failure = msgspec.json.decode(response.content, type=_Failure)
    except msgspec.DecodeError:
        failure = _Failure(message=f"the server returned HTTP status {response.status_code}")
    raise BusError(failure.message, where=failure.where, hint=failure.hint)
