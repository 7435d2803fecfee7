"""The planning process: reads requests from a socket, plans one at a time, and checks paths between work steps."""

from __future__ import annotations

import select
import socket
import sys
from collections import deque
from collections.abc import Callable, Sequence

import numpy as np

from engine.errors import FlexcellError
from engine.host.child_process import set_parent_death_signal
from engine.messages import Pose
from engine.messages.sensing import NEVER_SEEN, ObservedSpace
from engine.messages.shapes import Box, Obstacle
from robots.io.message_socket import MessageSocket, PeerGone
from robots.io.request_failure import RequestFailure
from robots.planning.request import (
    AttachedPartCheckRequest,
    CollisionRequest,
    JointGoal,
    PairDistanceRequest,
    PathCheckRequest,
    PlanRequest,
)
from robots.planning.scene.planning_scene import PlanningScene, SceneArm
from robots.planning.swept_space import SweptSpaceRequest
from robots.planning.worker.planning_messages import (
    CancelRequest,
    CollisionReply,
    FromPlanner,
    PlannerReady,
    PlanningRequest,
    ToPlanner,
    WarmUpRequest,
)
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import JointTrajectory
from robots.scene.sim_scene import ArmPlacement


class _RequestQueue:
    """The requests that have arrived, in order, and which of them are canceled."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._messages = MessageSocket[ToPlanner, FromPlanner](connection, ToPlanner)
        self._waiting: deque[tuple[int, PlanningRequest]] = deque()
        self._open: set[int] = set()
        self._canceled: set[int] = set()

    def next(self) -> tuple[int, PlanningRequest]:
        """Wait for the next request and return it with its number."""
        while not self._waiting:
            self._read()
        return self._waiting.popleft()

    def take_quick_requests(self) -> Sequence[tuple[int, PlanningRequest]]:
        """Read new messages, and remove and return the queued requests that take milliseconds."""
        while select.select([self._connection], [], [], 0.0)[0]:
            self._read()
        quick = [(number, request) for number, request in self._waiting if not isinstance(request, PlanRequest)]
        if quick:
            self._waiting = deque(waiting for waiting in self._waiting if isinstance(waiting[1], PlanRequest))
        return quick

    def is_canceled(self, number: int) -> bool:
        """Return whether a cancellation of the request has been read."""
        return number in self._canceled

    def answer(self, number: int, answer: FromPlanner) -> None:
        """Answer a request and forget it."""
        self._messages.send(answer, number=number)
        self._open.discard(number)
        self._canceled.discard(number)

    def _read(self) -> None:
        for number, message in self._messages.receive():
            if not isinstance(message, CancelRequest):
                self._waiting.append((number, message))
                self._open.add(number)
            elif number in self._open:
                self._canceled.add(number)


def main() -> None:
    """Serve the socket whose descriptor is the first argument until the other end closes it."""
    connection = socket.socket(fileno=int(sys.argv[1]))
    set_parent_death_signal(connection)
    queue = _RequestQueue(connection)
    planner = ScenePlanner()
    try:
        while True:
            _serve(planner, queue, *queue.next())
    except PeerGone:
        connection.close()


def _serve(planner: ScenePlanner, queue: _RequestQueue, number: int, request: PlanningRequest) -> None:
    def is_canceled() -> bool:
        # A moving arm must not wait for the plan of another.
        for quick_number, quick in queue.take_quick_requests():
            _serve(planner, queue, quick_number, quick)
        return queue.is_canceled(number)

    try:
        queue.answer(number, _answer(planner, request, is_canceled))
    except FlexcellError as error:
        queue.answer(number, RequestFailure.of(error))


def _answer(planner: ScenePlanner, request: PlanningRequest, is_canceled: Callable[[], bool]) -> FromPlanner:
    match request:
        case WarmUpRequest():
            warm_up(planner)
            return PlannerReady()
        case PlanRequest():
            return planner.plan(request, cancelled=is_canceled)
        case PathCheckRequest():
            return planner.check_path(request)
        case AttachedPartCheckRequest():
            return planner.check_attached_parts(request)
        case CollisionRequest():
            return CollisionReply(report=planner.look(request))
        case PairDistanceRequest():
            return planner.pair_distances(request)
        case SweptSpaceRequest():
            return planner.swept_space(request)


def warm_up(planner: ScenePlanner) -> None:
    """Compile and load everything that a first request would wait for."""
    placement = ArmPlacement(name="arm", model="servo_arm", base=Pose(xyz=(0.0, 0.0, 0.0)))
    far = Obstacle.of("far", Box(size_m=(0.1, 0.1, 0.1)), Pose(xyz=(5.0, 0.0, 0.0)))
    scene = PlanningScene(arms=(SceneArm(placement=placement),), obstacles=(far,))
    goal = JointGoal(joints_rad=((1.0, 0.0),))
    still = JointTrajectory(dt_s=0.1, position_rad=np.zeros((2, 2)), velocity_rad_s=np.zeros((2, 2)))
    unseen = ObservedSpace(
        time_s=0.0, corner_m=(0.0, 0.0, 0.0), voxel_m=0.1, shape=(1, 1, 1), limit_s=1.0, ages=bytes((NEVER_SEEN,))
    )
    planner.swept_space(SweptSpaceRequest(scene=scene, arm="arm", trajectory=still, observed=unseen))
    for name in ("fast", "RRTConnect"):
        planner.plan(
            PlanRequest(scene=scene, arm="arm", start_rad=(0.5, 0.0), goal=goal, speed=1.0, planner=name, time_s=60.0)
        )
