"""The planning process: reads requests from a socket, plans one at a time, and checks paths between work steps."""

from __future__ import annotations

import select
import socket
import sys
from collections import deque

import msgspec

from engine.errors import FlexcellError
from engine.host.child_process import set_parent_death_signal
from engine.messages import Pose
from engine.messages.shapes import Box, Obstacle
from robots.io.framed_socket import FramedSocket, PeerGone
from robots.planning.request import JointGoal, PlanRequest
from robots.planning.scene.planning_scene import PlanningScene, SceneArm
from robots.planning.worker.planning_messages import (
    AskAttachedPartCheck,
    AskCollisions,
    AskPathCheck,
    AskPlan,
    CancelRequest,
    CollisionReply,
    FromWorker,
    PlannerReady,
    PlanningReply,
    PlanningRequest,
    RequestFailure,
    ToWorker,
)
from robots.planning.worker.scene_planner import ScenePlanner
from robots.sim.scene.sim_scene import ArmPlacement


class _Mailbox:
    """The worker's end of the socket."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._messages = FramedSocket(connection)
        self._decode = msgspec.msgpack.Decoder(ToWorker).decode
        self._waiting: deque[PlanningRequest] = deque()
        self._open: set[int] = set()
        self._canceled: set[int] = set()

    def next(self) -> PlanningRequest:
        """Wait for the next request and return it."""
        while not self._waiting:
            self._read()
        return self._waiting.popleft()

    def take_quick_requests(self) -> list[AskPathCheck | AskAttachedPartCheck | AskCollisions]:
        """Read new messages, and remove and return the queued requests that take milliseconds."""
        while select.select([self._connection], [], [], 0.0)[0]:
            self._read()
        quick = [ask for ask in self._waiting if not isinstance(ask, AskPlan)]
        if quick:
            self._waiting = deque(ask for ask in self._waiting if isinstance(ask, AskPlan))
        return quick

    def is_canceled(self, number: int) -> bool:
        """Return whether a cancellation of the request has been read."""
        return number in self._canceled

    def send(self, message: FromWorker) -> None:
        """Send a message."""
        self._messages.send(msgspec.msgpack.encode(message))

    def done(self, number: int) -> None:
        """Remove an answered request."""
        self._open.discard(number)
        self._canceled.discard(number)

    def _read(self) -> None:
        for frame in self._messages.receive():
            message = self._decode(frame)
            if not isinstance(message, CancelRequest):
                self._waiting.append(message)
                self._open.add(message.number)
            elif message.number in self._open:
                self._canceled.add(message.number)


def main() -> None:
    """Serve the socket whose descriptor is the first argument until the other end closes it."""
    connection = socket.socket(fileno=int(sys.argv[1]))
    set_parent_death_signal(connection)
    mailbox = _Mailbox(connection)
    planner = ScenePlanner()
    try:
        warm_up(planner)
        mailbox.send(PlannerReady())
        while True:
            _serve(planner, mailbox, mailbox.next())
    except PeerGone:
        connection.close()


def _serve(planner: ScenePlanner, mailbox: _Mailbox, ask: PlanningRequest) -> None:
    mailbox.send(_answer(planner, mailbox, ask))
    mailbox.done(ask.number)


def _answer(planner: ScenePlanner, mailbox: _Mailbox, ask: PlanningRequest) -> FromWorker:
    def is_canceled() -> bool:
        # A moving arm must not wait for the plan of another.
        for quick in mailbox.take_quick_requests():
            _serve(planner, mailbox, quick)
        return mailbox.is_canceled(ask.number)

    try:
        match ask:
            case AskPlan(number=number, request=request):
                return PlanningReply(number=number, answer=planner.plan(request, cancelled=is_canceled))
            case AskPathCheck(number=number, request=request):
                return PlanningReply(number=number, answer=planner.check_path(request))
            case AskAttachedPartCheck(number=number, request=request):
                return PlanningReply(number=number, answer=planner.check_attached_parts(request))
            case AskCollisions(number=number, request=request):
                return CollisionReply(number=number, answer=planner.look(request))
    except FlexcellError as error:
        where = str(error.where) if error.where is not None else ""
        return RequestFailure(number=ask.number, message=error.message, where=where, hint=error.hint or "")


def warm_up(planner: ScenePlanner) -> None:
    """Compile and load everything that a first request would wait for."""
    placement = ArmPlacement(name="arm", model="servo_arm", base=Pose(xyz=(0.0, 0.0, 0.0)))
    far = Obstacle.of("far", Box(size_m=(0.1, 0.1, 0.1)), Pose(xyz=(5.0, 0.0, 0.0)))
    scene = PlanningScene(arms=(SceneArm(placement=placement),), obstacles=(far,))
    goal = JointGoal(joints_rad=((1.0, 0.0),))
    for name in ("fast", "RRTConnect"):
        planner.plan(
            PlanRequest(scene=scene, arm="arm", start_rad=(0.5, 0.0), goal=goal, speed=1.0, planner=name, time_s=60.0)
        )
