"""Dragging an arm by its handle in the 3D view: the tool follows the handle, or is pushed towards it, during the drag.

A drag needs two signals: viser's drag events, and a keep-alive of the page every 50 ms. When either ends, for any
reason, the arm comes to rest. A drag is a press: one that is over before the arm has moved is executed for a moment.
"""

from __future__ import annotations

import asyncio
import math
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Annotated, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from editor_web.cell_view import CellView, DragHandle, HandlePull
from editor_web.cell_view.rendering.transforms import WorldPose, poses_by_frame
from editor_web.teaching.jogging import Jogger, ToPage
from editor_web.teaching.teaching_messages import PressDropped, PushToolBody, RefusedFrame, StartJog
from editor_web.teaching.tool_push import push
from engine.errors import FlexcellError
from engine.messages import FramePoses, RobotDescription
from engine.messages.pose_algebra import rotation_vector_between
from engine.project import Session

PERIOD_S = 0.05
SILENCE_S = 0.2
"""Maximum time without a keep-alive of the page; then the drag counts as ended."""
MOST_M_S, MOST_RAD_S, GAIN_1_S = 0.1, 0.5, 2.0
NEAR_M, NEAR_RAD = 0.001, 0.01
MOST_N, SPRING_N_M, PUSH_S = 40.0, 200.0, 0.15

HandleMode = Literal["move", "push"]
Vector = NDArray[np.float64]


class ShowHandle(msgspec.Struct, frozen=True, kw_only=True, tag="take", tag_field="k"):
    """From the page: show the handle of this arm (empty: none); it moves the tool, or pushes an arm in hand guiding."""

    arm: Annotated[str, msgspec.Meta(max_length=200)] = ""
    mode: HandleMode = "move"


class DragKeepAlive(msgspec.Struct, frozen=True, kw_only=True, tag="held", tag_field="k"):
    """From the page, every 50 ms while the mouse is down on its 3D view."""


class HandleStatus(msgspec.Struct, frozen=True, kw_only=True, tag="gripped", tag_field="k"):
    """To the page: the arm whose handle it has (empty: none), and whether the handle is dragged."""

    arm: str
    mode: HandleMode
    pulled: bool


FrameSender = Callable[[HandleStatus | RefusedFrame], None]


@dataclass(kw_only=True)
class _Drag:
    """One drag: where the handle is, whether the mouse is up again, and whether the tool was told to follow."""

    target: WorldPose
    is_over: asyncio.Event = field(default_factory=asyncio.Event)
    is_commanded: bool = False


class HandleDrag:
    """The drag handle of one page in its 3D view; on the event loop.

    Args:
        backend: The engine.
        view: The 3D view.
        page: Name of the page in the view.
        joggers: The active jogger of each arm, for all pages.
        send: Receives the messages to the page.
    """

    def __init__(
        self, backend: Session, view: CellView, page: str, *, joggers: dict[str, Jogger], send: FrameSender
    ) -> None:
        self._backend = backend
        self._view = view
        self._page = page
        self._send = send
        self._jogger = Jogger(backend.bus, taken=joggers, send=self._on_jog)
        self._loop = asyncio.get_running_loop()
        self._take = ShowHandle()
        self._handle: DragHandle | None = None
        # At the end the drag that goes on; before it those that the arm has not followed yet.
        self._drags: deque[_Drag] = deque()
        self._held_s = -math.inf
        self._is_refused = False
        self._task: asyncio.Task[None] | None = None

    async def take(self, take: ShowHandle) -> None:
        """Show the handle of an arm, or none."""
        await self._stop_drag()
        self._take = take
        description = self._backend.latest(f"{take.arm}/description") if take.arm else None
        if isinstance(description, RobotDescription):
            turns = take.mode == "move"
            self._handle = DragHandle(frame=description.tool_frame, turns=turns, pulled=self._on_pull(take))
            self._view.give_handle(self._page, self._handle)
        else:
            self._remove_handle()
            if take.arm:
                self._refuse("there is no such arm", "choose an arm of the cell")
            self._take = ShowHandle()
        self._send_status()

    def held(self) -> None:
        """Record a keep-alive of the page: the mouse is down."""
        self._held_s = self._loop.time()

    async def close(self) -> None:
        """Bring the arm to rest and remove the handle."""
        await self._stop_drag()
        self._remove_handle()

    def _remove_handle(self) -> None:
        # Meanwhile the page may have reconnected, with a new handle.
        handle, self._handle = self._handle, None
        if handle is not None:
            self._view.take_handle(self._page, handle)

    async def _stop_drag(self) -> None:
        # Ignores the handle from now on, which the page can drag until it is removed.
        self._take = ShowHandle()
        self._drags.clear()
        task, self._task = self._task, None
        if task is not None:
            task.cancel()
            await asyncio.wait({task})
        await self._jogger.rest()

    def _on_pull(self, take: ShowHandle) -> Callable[[HandlePull], None]:
        def pulled(pull: HandlePull) -> None:
            # On viser's thread.
            self._loop.call_soon_threadsafe(self._pulled, take, pull)

        return pulled

    def _pulled(self, take: ShowHandle, pull: HandlePull) -> None:
        if take is not self._take:
            return
        if pull.phase == "start":
            self._drags.append(_Drag(target=pull.pose))
            if self._task is None or self._task.done():
                self._task = asyncio.create_task(self._follow(take), name=f"handle of {take.arm}")
        elif self._drags and pull.phase == "end":
            self._drags[-1].is_over.set()
        elif self._drags:
            self._drags[-1].target = pull.pose

    async def _follow(self, take: ShowHandle) -> None:
        """Follow the drags, one after the other."""
        self._is_refused = False
        self._send_status()
        try:
            while self._drags and not self._is_refused:
                await self._follow_drag(take, self._drags[0])
                self._drags.popleft()
        except FlexcellError as error:
            self._refuse(error.message, error.hint or "")
        finally:
            if self._drags:
                # Not let go but broken off.
                self._drags.clear()
                await self._rest(take)
            self._send_status()

    async def _follow_drag(self, take: ShowHandle, drag: _Drag) -> None:
        while not self._is_refused:
            if self._loop.time() - self._held_s < SILENCE_S:
                await self._step(take, drag.target)
                drag.is_commanded = True
            else:
                # The drag resumes if keep-alives arrive again while the mouse is still down.
                await self._jogger.rest()
            if drag.is_over.is_set():
                break
            # What was said last before the mouse went up counts too.
            with suppress(TimeoutError):
                async with asyncio.timeout(PERIOD_S):
                    await drag.is_over.wait()
        if not drag.is_commanded:
            self._refuse(
                "the drag has moved nothing: it was over before the arm could follow", "drag again, for longer"
            )
        await self._release(take)

    async def _step(self, take: ShowHandle, target: WorldPose) -> None:
        now = self._now(take.arm)
        if take.mode == "push":
            await self._push(take.arm, _force(now, target))
            return
        if not self._jogger.arm:
            await self._jogger.begin(StartJog(arm=take.arm, space="tool", frame="world"))
        await self._jogger.go(_velocity(now, target))

    async def _release(self, take: ShowHandle) -> None:
        if take.mode == "move":
            await self._jogger.release()
        else:
            await self._end_push(take)

    async def _rest(self, take: ShowHandle) -> None:
        if take.mode == "move":
            await self._jogger.rest()
        else:
            await self._end_push(take)

    async def _end_push(self, take: ShowHandle) -> None:
        try:
            await self._push(take.arm, (0.0, 0.0, 0.0))
        except FlexcellError:
            return  # the arm left hand guiding, or its world is closed; the last push ends by itself

    async def _push(self, arm: str, force_n: tuple[float, float, float]) -> None:
        await push(self._backend, PushToolBody(arm=arm, force_n=force_n, duration_s=PUSH_S))

    def _now(self, arm: str) -> WorldPose:
        description, poses = self._backend.latest(f"{arm}/description"), self._backend.latest("cell/frames")
        if isinstance(description, RobotDescription) and isinstance(poses, FramePoses):
            now = poses_by_frame(poses).get(description.tool_frame)
            if now is not None:
                return now
        raise FlexcellError("the pose of the tool is unknown", where=arm)

    def _on_jog(self, status: ToPage) -> None:
        if isinstance(status, RefusedFrame):
            self._is_refused = True
            self._send(status)
        elif isinstance(status, PressDropped) and not self._drags:
            # In a drag the tool still follows.
            self._refuse(f"the drag has moved nothing: the arm could not begin within {status.within_s:g} s", "")

    def _refuse(self, message: str, hint: str) -> None:
        self._send(RefusedFrame(what="jog", message=message, hint=hint))

    def _send_status(self) -> None:
        self._send(HandleStatus(arm=self._take.arm, mode=self._take.mode, pulled=bool(self._drags)))


def _velocity(now: WorldPose, target: WorldPose) -> tuple[float, ...]:
    """Return the velocity of the tool towards the handle, m/s and rad/s in the world."""
    offset = np.subtract(target.xyz, now.xyz)
    rotation = np.array(rotation_vector_between(now.xyzw, target.xyzw))
    linear = _limited(offset * GAIN_1_S, MOST_M_S) if np.linalg.norm(offset) > NEAR_M else np.zeros(3)
    angular = _limited(rotation * GAIN_1_S, MOST_RAD_S) if np.linalg.norm(rotation) > NEAR_RAD else np.zeros(3)
    return tuple(float(value) for value in (*linear, *angular))


def _force(now: WorldPose, target: WorldPose) -> tuple[float, float, float]:
    x, y, z = _limited(np.subtract(target.xyz, now.xyz) * SPRING_N_M, MOST_N)
    return (float(x), float(y), float(z))


def _limited(vector: Vector, most: float) -> Vector:
    length = float(np.linalg.norm(vector))
    return vector if length <= most else vector * (most / length)
