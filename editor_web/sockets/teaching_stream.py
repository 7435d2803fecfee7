"""Teaching: the page's own connection, with which jogging and buttons end, and what it asks of entries and captures."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Annotated, cast

import msgspec
from fastapi import APIRouter, Query, Request, Response, WebSocket

from editor_web.cell_view import CellView
from editor_web.contracts.backend import Backend, Unsubscribe
from editor_web.routes.bus import CLIENT_CLOSED_REQUEST, run_while_connected
from editor_web.routes.responses import json_response
from editor_web.routes.services import ServicesOf, role_of, services_of
from editor_web.security.authentication import OPERATOR
from editor_web.sockets.page_socket import PageDisconnected, read_message, send_message
from editor_web.teaching.arm_status import ArmStatusReader
from editor_web.teaching.buttons import PressedButtons
from editor_web.teaching.jogging import Jogger
from editor_web.teaching.playback import play
from editor_web.teaching.taught_entries import compare_primitive, read_taught, search_entries, trace, write_tags
from editor_web.teaching.teaching_messages import (
    ArmsLiveFrame,
    ButtonInput,
    EntriesChanged,
    FromPage,
    HelpingHandFrame,
    JogStatus,
    JogVelocity,
    PlayBody,
    PreviewTaught,
    PushToolBody,
    RefusedFrame,
    StartJog,
    StopJog,
    TagsBody,
    ToPage,
)
from editor_web.teaching.tool_push import push
from engine.errors import FlexcellError
from engine.skills.planning import PathPreview
from engine.skills.teaching import TeachStatus

router = APIRouter(prefix="/api/v1/teach", tags=["teaching"])
PERIOD_S = 0.1
MOST_WAITING = 200
MOST_ENTRIES = 200
PAGE_NAME = "^[0-9a-z]{0,40}$"
_decoder: msgspec.json.Decoder[FromPage] = msgspec.json.Decoder(FromPage)


@router.get("/entries")
async def list_entries(
    services: ServicesOf,
    kind: Annotated[str, Query(max_length=40)] = "",
    text: Annotated[str, Query(max_length=200)] = "",
    limit: Annotated[int, Query(ge=1, le=MOST_ENTRIES)] = 100,
) -> Response:
    """List entries of the cell's store, each with its last change."""
    return json_response(await search_entries(services.backend.bus, kind=kind, text=text, limit=limit))


@router.get("/fits")
async def get_fits(
    services: ServicesOf,
    arm: Annotated[str, Query(max_length=100)],
    kind: Annotated[str, Query(max_length=40)] = "",
    name: Annotated[str, Query(max_length=200)] = "",
    capture: Annotated[int, Query(ge=0)] = 0,
    revision: Annotated[int, Query(ge=0)] = 0,
) -> Response:
    """Return how an arm would go along an entry or a capture, beside the recording that it was learned from."""
    look = PreviewTaught(arm=arm, kind=kind, name=name, capture=capture, revision=revision)
    return json_response(await compare_primitive(services.backend.bus, arm, look))


@router.post("/tags", status_code=204)
async def set_tags(body: TagsBody, services: ServicesOf) -> None:
    """Give an entry other tags."""
    await write_tags(services.backend.bus, body)


@router.post("/play")
async def play_back(body: PlayBody, request: Request, services: ServicesOf) -> Response:
    """Carry out what was taught, slowly; it is stopped when the page goes. This moves the robot."""
    played = await run_while_connected(play(services.backend.bus, body), request, name=f"play {body.arm}")
    return Response(status_code=CLIENT_CLOSED_REQUEST) if played is None else json_response(played)


@router.post("/push", status_code=204)
async def push_tool(body: PushToolBody, services: ServicesOf) -> None:
    """Push at the tool of a simulated arm that floats."""
    await push(services.backend, body)


@router.websocket("/live")
async def teach_live(socket: WebSocket, page: Annotated[str, Query(pattern=PAGE_NAME)] = "") -> None:
    """Serve one page: arms and captures go out; jogging, buttons and ghosts come in, and end with the connection.

    Ghosts are seen in the 3D view that was loaded with the name `page`, and nowhere else.
    """
    services = services_of(socket)
    await socket.accept()
    joggers = cast("dict[str, Jogger]", socket.app.state.joggers)
    may_operate = role_of(socket) == OPERATOR
    client = _Page(services.backend, services.cell_view, joggers, name=page, may_operate=may_operate)
    try:
        await client.open()
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(_receive(socket, client), name="teach-receive")
            tasks.create_task(_stream(socket, client), name="teach-stream")
    except* PageDisconnected:
        pass
    finally:
        await client.close()


class _Page:
    """One page and what it holds."""

    def __init__(
        self, backend: Backend, view: CellView | None, joggers: dict[str, Jogger], *, name: str, may_operate: bool
    ) -> None:
        self._backend = backend
        self._name = name
        self._view = view
        self._may_operate = may_operate
        self._waiting: deque[ToPage] = deque(maxlen=MOST_WAITING)
        self._board = ArmStatusReader(backend)
        self._jogger = Jogger(backend.bus, taken=joggers, tell=self._waiting.append)
        self._buttons = PressedButtons(backend.bus, tell=self._waiting.append)
        self._unsubscribe: list[Unsubscribe] = []
        self._hand: TeachStatus | None = None
        self._is_hand_news = True
        self._are_entries_news = False
        self._held_by = ""
        self._looked_at: set[tuple[str, int]] = set()
        self._looking: dict[int, asyncio.Task[None]] = {}

    async def open(self) -> None:
        """Follow what the page is told of."""
        self._waiting.append(await self._board.arms())
        self._follow("teach/status", self._on_hand)
        self._follow("store/changes", self._on_entries)

    async def close(self) -> None:
        """Let go of everything: the arm first."""
        await self._jogger.rest()
        await self._buttons.release()
        await self._look_away()
        for unsubscribe in self._unsubscribe:
            unsubscribe()

    async def take(self, request: FromPage) -> None:
        """Do what the page says; a viewer's page may only look."""
        match request:
            case PreviewTaught():
                await self._look_away(request.place)
                if request.arm:
                    self._looking[request.place] = asyncio.create_task(self._look(request), name="teach-look")
            case _ if not self._may_operate:
                self._waiting.append(
                    RefusedFrame(what="jog", message="you may look only", hint="log in with the operator token")
                )
            case StartJog():
                await self._jogger.begin(request)
            case JogVelocity():
                await self._jogger.go(request.velocity)
            case StopJog():
                await self._jogger.rest()
            case ButtonInput():
                await self._buttons.take(request)

    async def news(self) -> list[ToPage]:
        """Return what the page has not been told."""
        told: list[ToPage] = list(self._waiting)
        self._waiting.clear()
        if self._is_hand_news:
            self._is_hand_news = False
            told.append(HelpingHandFrame(status=self._hand))
        if self._are_entries_news:
            self._are_entries_news = False
            told.append(EntriesChanged())
        if (jogging := self._jogging()) is not None:
            told.append(jogging)
        arms = await self._board.changed()
        return [*told, ArmsLiveFrame(arms=arms)] if arms else told

    def _jogging(self) -> JogStatus | None:
        """Return what holds the jogged arm back, where that is another than told."""
        arm = self._jogger.arm
        goals = self._backend.desk.goals() if arm else ()
        feedback = next((each.feedback for each in goals if each.address.startswith(f"{arm}/jog_")), None)
        held_by = str(getattr(feedback, "held_by", ""))
        if held_by == self._held_by:
            return None
        self._held_by = held_by
        return JogStatus(arm=arm, held_by=held_by) if arm else None

    def _follow(self, topic: str, callback: Callable[[object], None]) -> None:
        try:
            self._unsubscribe.append(self._backend.subscribe_topic(topic, callback))
        except FlexcellError:
            # A cell without a Helping Hand or a store; the page says what is missing.
            return

    def _on_hand(self, message: object) -> None:
        self._hand = message if isinstance(message, TeachStatus) else None
        self._is_hand_news = True

    def _on_entries(self, _message: object) -> None:
        self._are_entries_news = True

    async def _look(self, look: PreviewTaught) -> None:
        try:
            course = await trace(self._backend.bus, look.arm, await read_taught(self._backend.bus, look))
        except FlexcellError as error:
            self._waiting.append(RefusedFrame(what="look", message=error.message, hint=error.hint or ""))
            return
        if course.remark:
            self._waiting.append(RefusedFrame(what="look", message=course.remark, hint=""))
        if self._view is not None:
            self._looked_at.add((look.arm, look.place))
            self._view.show_ghost(
                self._name,
                PathPreview(
                    robot=look.arm,
                    state="proposed",
                    joint_names=course.joint_names,
                    joints=course.joints,
                    tool_path=tuple((pose[0], pose[1], pose[2]) for pose in course.poses),
                ),
                place=look.place,
            )

    async def _look_away(self, place: int = 0) -> None:
        """Show nothing there any more; with `place` 0 nowhere."""
        tasks = [self._looking.pop(each) for each in tuple(self._looking) if place in (0, each)]
        for task in tasks:
            task.cancel()
        if tasks:
            await asyncio.wait(tasks)
        gone = {each for each in self._looked_at if place in (0, each[1])}
        self._looked_at -= gone
        for arm, at in gone:
            if self._view is not None:
                self._view.show_ghost(self._name, PathPreview(robot=arm, state="none"), place=at)


async def _receive(socket: WebSocket, page: _Page) -> None:
    while True:
        await page.take(await read_message(socket, _decoder, expected="a message of the page for teaching"))


async def _stream(socket: WebSocket, page: _Page) -> None:
    while True:
        for message in await page.news():
            await send_message(socket, message)
        # The frame rate's limit; what happens meanwhile is coalesced.
        await asyncio.sleep(PERIOD_S)
