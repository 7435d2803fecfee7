"""Teaching: the websocket of a page, whose end stops jogging and buttons, and the routes for entries and captures."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import Annotated, cast

import msgspec
from fastapi import Query, Request, Response, WebSocket
from msgspec.structs import asdict

from editor_web.cell_view import NO_MARKS, CellView, DragHandle, HandlePull, Marks
from editor_web.cell_view.rendering.transforms import WorldPose
from editor_web.routes.bus import CLIENT_CLOSED_REQUEST, run_while_connected
from editor_web.routes.services import ServicesOf, role_of, services_of
from editor_web.routes.wire_router import WireRouter
from editor_web.security.authentication import OPERATOR
from editor_web.sockets.page_socket import PageDisconnected, read_message, send_message
from editor_web.teaching.arm_status import ArmStatusReader
from editor_web.teaching.buttons import PressedButtons
from editor_web.teaching.jog_readiness import JogPreparation
from editor_web.teaching.jogging import Jogger
from editor_web.teaching.playback import play
from editor_web.teaching.taught_entries import (
    TaughtData,
    compare_primitive,
    read_taught,
    search_entries,
    trace,
    write_tags,
)
from editor_web.teaching.teaching_messages import (
    ArmsLiveFrame,
    ButtonInput,
    EntriesChanged,
    EntryPage,
    FromPage,
    HelpingHandFrame,
    ItemHandleMoved,
    JogBlockFrame,
    JogStatus,
    JogVelocity,
    PlaybackResult,
    PlayBody,
    PrepareJogging,
    PreviewTaught,
    PrimitiveComparison,
    PushToolBody,
    RefusedFrame,
    ShowItemHandle,
    ShowMarks,
    StartJog,
    StopJog,
    TagsBody,
    TaughtReference,
    ToPage,
)
from editor_web.teaching.tool_push import push
from engine.errors import FlexcellError
from engine.project import Session
from engine.skills.jogging import JogBlock
from engine.skills.planning import PathPreview
from engine.skills.teaching import TeachStatus

router = WireRouter(prefix="/api/v1/teach", tags=["teaching"])
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
) -> EntryPage:
    """List entries of the cell's store, each with its last change."""
    return await search_entries(services.backend.bus, kind=kind, text=text, limit=limit)


@router.get("/fits")
async def get_fits(
    services: ServicesOf,
    arm: Annotated[str, Query(max_length=100)],
    kind: Annotated[str, Query(max_length=40)] = "",
    name: Annotated[str, Query(max_length=200)] = "",
    capture: Annotated[int, Query(ge=0)] = 0,
    revision: Annotated[int, Query(ge=0)] = 0,
) -> PrimitiveComparison:
    """Return the motion of an arm along an entry or a capture, with the recording that it was learned from."""
    reference = TaughtReference(kind=kind, name=name, capture=capture, revision=revision)
    return await compare_primitive(services.backend.bus, arm, reference)


@router.post("/tags", status_code=204)
async def set_tags(body: TagsBody, services: ServicesOf) -> None:
    """Replace the tags of an entry."""
    await write_tags(services.backend.bus, body)


@router.post("/play")
async def play_back(body: PlayBody, request: Request, services: ServicesOf) -> PlaybackResult | Response:
    """Play back a taught motion, slowly; it stops if the page disconnects. This moves the robot."""
    played = await run_while_connected(play(services.backend.bus, body), request, name=f"play {body.arm}")
    return Response(status_code=CLIENT_CLOSED_REQUEST) if played is None else played


@router.post("/push", status_code=204)
async def push_tool(body: PushToolBody, services: ServicesOf) -> None:
    """Push the tool of a simulated arm in hand guiding."""
    await push(services.backend, body)


@router.websocket("/live")
async def teach_live(socket: WebSocket, page: Annotated[str, Query(pattern=PAGE_NAME)] = "") -> None:
    """Serve one page: send arms and captures; receive jogging, buttons and previews, which end with the connection.

    Previews are visible only in the 3D view that was loaded with the name `page`.
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
    """One page with its jogged arm, pressed buttons and previews."""

    def __init__(
        self, backend: Session, view: CellView | None, joggers: dict[str, Jogger], *, name: str, may_operate: bool
    ) -> None:
        self._backend = backend
        self._name = name
        self._view = view
        self._may_operate = may_operate
        self._waiting: deque[ToPage] = deque(maxlen=MOST_WAITING)
        self._board = ArmStatusReader(backend)
        self._jogger = Jogger(backend.bus, taken=joggers, send=self._waiting.append)
        self._preparation = JogPreparation(backend.bus, self._waiting.append)
        self._block: JogBlock | None = None
        self._buttons = PressedButtons(backend.bus, send=self._waiting.append)
        self._unsubscribe: list[Callable[[], None]] = []
        self._hand: TeachStatus | None = None
        self._is_hand_changed = True
        self._are_entries_changed = False
        self._held_by = ""
        self._has_marks = False
        self._handle: DragHandle | None = None
        self._previews: set[tuple[str, int]] = set()
        self._preview_tasks: dict[int, asyncio.Task[None]] = {}

    async def open(self) -> None:
        """Subscribe to the topics of the page."""
        self._waiting.append(await self._board.arms())
        self._follow("teach/status", self._on_hand)
        self._follow("store/changes", self._on_entries)
        self._unsubscribe.append(self._backend.recovery.when_changed(self._preparation.repeat))

    async def close(self) -> None:
        """Release everything: the arm first."""
        await self._jogger.rest()
        await self._preparation.close()
        await self._buttons.release()
        await self._clear_previews()
        if self._has_marks:
            self._mark(NO_MARKS)
        self._show_handle(ShowItemHandle())
        for unsubscribe in self._unsubscribe:
            unsubscribe()

    async def take(self, request: FromPage) -> None:
        """Execute a message of the page; a viewer's page has read-only access."""
        match request:
            case PreviewTaught():
                await self._clear_previews(request.place)
                if request.arm:
                    self._preview_tasks[request.place] = asyncio.create_task(self._preview(request), name="teach-look")
            case ShowMarks():
                self._mark(request)
            case _ if not self._may_operate:
                self._waiting.append(
                    RefusedFrame(what="jog", message="you may look only", hint="log in with the operator token")
                )
            case ShowItemHandle():
                self._show_handle(request)
            case PrepareJogging():
                self._preparation.begin(request.arm)
            case StartJog():
                await self._jogger.begin(request)
            case JogVelocity():
                await self._jogger.go(request.velocity)
            case StopJog():
                await self._jogger.release()
            case ButtonInput():
                await self._buttons.take(request)

    async def pending_messages(self) -> list[ToPage]:
        """Return the pending messages to the page."""
        messages: list[ToPage] = list(self._waiting)
        self._waiting.clear()
        if self._is_hand_changed:
            self._is_hand_changed = False
            messages.append(HelpingHandFrame(status=self._hand))
        if self._are_entries_changed:
            self._are_entries_changed = False
            messages.append(EntriesChanged())
        if (jogging := self._jogging()) is not None:
            messages.append(jogging)
        if (block := self._jog_block()) is not None:
            messages.append(block)
        arms = await self._board.changed()
        return [*messages, ArmsLiveFrame(arms=arms)] if arms else messages

    def _jogging(self) -> JogStatus | None:
        """Return what limits the jogged arm, if that has changed."""
        arm = self._jogger.arm
        goals = self._backend.inspector.goals() if arm else ()
        feedback = next((each.feedback for each in goals if each.address.startswith(f"{arm}/jog_")), None)
        held_by = str(getattr(feedback, "held_by", ""))
        if held_by == self._held_by:
            return None
        self._held_by = held_by
        return JogStatus(arm=arm, held_by=held_by) if arm else None

    def _jog_block(self) -> JogBlockFrame | None:
        """Return what the arm of the page stands before, if that has changed."""
        arm = self._preparation.arm
        block = self._backend.latest(f"{arm}/jog_block") if arm else None
        if not isinstance(block, JogBlock) or block == self._block:
            return None
        self._block = block
        return JogBlockFrame(**asdict(block))

    def _follow(self, topic: str, callback: Callable[[object], None]) -> None:
        try:
            self._unsubscribe.append(self._backend.subscribe_topic(topic, callback))
        except FlexcellError:
            # A cell without a Helping Hand or a store; the page reports what is missing.
            return

    def _on_hand(self, message: object) -> None:
        self._hand = message if isinstance(message, TeachStatus) else None
        self._is_hand_changed = True

    def _on_entries(self, _message: object) -> None:
        self._are_entries_changed = True

    async def _preview(self, request: PreviewTaught) -> None:
        try:
            bus = self._backend.bus
            given = request.value
            taught = (
                TaughtData(kind=request.kind, value=given) if given is not None else await read_taught(bus, request)
            )
            motion = await trace(bus, request.arm, taught)
        except FlexcellError as error:
            self._waiting.append(RefusedFrame(what="look", message=error.message, hint=error.hint or ""))
            return
        if motion.remark:
            self._waiting.append(RefusedFrame(what="look", message=motion.remark, hint=""))
        if self._view is not None:
            self._previews.add((request.arm, request.place))
            self._view.show_ghost(
                self._name,
                PathPreview(
                    robot=request.arm,
                    state="proposed",
                    joint_names=motion.joint_names,
                    joints=motion.joints,
                    tool_path=tuple((pose[0], pose[1], pose[2]) for pose in motion.poses),
                ),
                place=request.place,
            )

    def _mark(self, marks: Marks) -> None:
        if self._view is not None:
            self._has_marks = not marks.is_empty
            self._view.show_marks(self._name, marks)

    def _show_handle(self, request: ShowItemHandle) -> None:
        """Show a handle in the place of the one before; a drag of it is only told to the page."""
        if self._view is None:
            return
        if self._handle is not None:
            self._view.take_handle(self._name, self._handle)
            self._handle = None
        if request.at is not None:
            loop = asyncio.get_running_loop()

            def pulled(pull: HandlePull) -> None:
                moved = ItemHandleMoved(phase=pull.phase, xyz=pull.pose.xyz, xyzw=pull.pose.xyzw)
                with suppress(RuntimeError):  # the loop has just been closed, and with it the page's connection
                    loop.call_soon_threadsafe(self._waiting.append, moved)

            xyz, xyzw = request.at
            self._handle = DragHandle(turns=request.turns, at=WorldPose(xyz=xyz, xyzw=xyzw), pulled=pulled)
            self._view.give_handle(self._name, self._handle)

    async def _clear_previews(self, place: int = 0) -> None:
        """Clear the preview at a place; `place` 0 clears all."""
        tasks = [self._preview_tasks.pop(each) for each in tuple(self._preview_tasks) if place in (0, each)]
        for task in tasks:
            task.cancel()
        if tasks:
            await asyncio.wait(tasks)
        cleared = {each for each in self._previews if place in (0, each[1])}
        self._previews -= cleared
        for arm, at in cleared:
            if self._view is not None:
                self._view.show_ghost(self._name, PathPreview(robot=arm, state="none"), place=at)


async def _receive(socket: WebSocket, page: _Page) -> None:
    while True:
        await page.take(await read_message(socket, _decoder, expected="a teaching message"))


async def _stream(socket: WebSocket, page: _Page) -> None:
    while True:
        for message in await page.pending_messages():
            await send_message(socket, message)
        # Limit of the frame rate; changes in between are coalesced.
        await asyncio.sleep(PERIOD_S)
