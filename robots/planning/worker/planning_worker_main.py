"""The planning process: takes requests from a socket, plans one at a time, and looks at ways meanwhile."""

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
        self._withdrawn: set[int] = set()

    def next(self) -> PlanningRequest:
        """Return the next request, once there is one."""
        while not self._waiting:
            self._read()
        return self._waiting.popleft()

    def quick_ones(self) -> list[AskPathCheck | AskAttachedPartCheck | AskCollisions]:
        """Return the requests that take milliseconds, reading what has arrived meanwhile; they are not waiting then."""
        while select.select([self._connection], [], [], 0.0)[0]:
            self._read()
        found = [ask for ask in self._waiting if not isinstance(ask, AskPlan)]
        if found:
            self._waiting = deque(ask for ask in self._waiting if isinstance(ask, AskPlan))
        return found

    def is_withdrawn(self, number: int) -> bool:
        """Return whether a request, as far as was read, is no longer wanted."""
        return number in self._withdrawn

    def send(self, message: FromWorker) -> None:
        """Send a message."""
        self._messages.send(msgspec.msgpack.encode(message))

    def done(self, number: int) -> None:
        """Forget about a request that was answered."""
        self._open.discard(number)
        self._withdrawn.discard(number)

    def _read(self) -> None:
        for frame in self._messages.receive():
            message = self._decode(frame)
            if not isinstance(message, CancelRequest):
                self._waiting.append(message)
                self._open.add(message.number)
            elif message.number in self._open:
                self._withdrawn.add(message.number)


def main() -> None:
    """Serve the socket whose descriptor is the first argument until the other end closes it."""
    connection = socket.socket(fileno=int(sys.argv[1]))
    set_parent_death_signal(connection)
    mailbox = _Mailbox(connection)
    planner = ScenePlanner()
    try:
        _warm(planner)
        mailbox.send(PlannerReady())
        while True:
            _serve(planner, mailbox, mailbox.next())
    except PeerGone:
        connection.close()


def _serve(planner: ScenePlanner, mailbox: _Mailbox, ask: PlanningRequest) -> None:
    mailbox.send(_answer(planner, mailbox, ask))
    mailbox.done(ask.number)


def _answer(planner: ScenePlanner, mailbox: _Mailbox, ask: PlanningRequest) -> FromWorker:
    def is_withdrawn() -> bool:
        # An arm under way must not wait for the plan of another.
        for quick in mailbox.quick_ones():
            _serve(planner, mailbox, quick)
        return mailbox.is_withdrawn(ask.number)

    try:
        match ask:
            case AskPlan(number=number, request=request):
                return PlanningReply(number=number, answer=planner.plan(request, cancelled=is_withdrawn))
            case AskPathCheck(number=number, request=request):
                return PlanningReply(number=number, answer=planner.check_path(request))
            case AskAttachedPartCheck(number=number, request=request):
                return PlanningReply(number=number, answer=planner.check_attached_parts(request))
            case AskCollisions(number=number, request=request):
                return CollisionReply(number=number, answer=planner.look(request))
    except FlexcellError as error:
        where = str(error.where) if error.where is not None else ""
        return RequestFailure(number=ask.number, message=error.message, where=where, hint=error.hint or "")


def _warm(planner: ScenePlanner) -> None:
    """Have everything compiled and loaded that a first request would wait for."""
    placement = ArmPlacement(name="arm", model="servo_arm", base=Pose(xyz=(0.0, 0.0, 0.0)))
    far = Obstacle.of("far", Box(size_m=(0.1, 0.1, 0.1)), Pose(xyz=(5.0, 0.0, 0.0)))
    scene = PlanningScene(arms=(SceneArm(placement=placement),), obstacles=(far,))
    goal = JointGoal(joints_rad=((1.0, 0.0),))
    for name in ("fast", "RRTConnect"):
        planner.plan(
            PlanRequest(scene=scene, arm="arm", start_rad=(0.5, 0.0), goal=goal, speed=1.0, planner=name, time_s=60.0)
        )
