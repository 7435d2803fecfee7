"""A backend without robots: plays believable runs of a few behaviors, for tests and for work on the page."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from editor_web.operation import Attached, InterruptedRun
from engine.bus.access import BusAccess
from engine.control import Control
from engine.errors import ControlError, FlexcellError
from engine.event import (
    Cause,
    Entered,
    Event,
    Exited,
    GoalFinished,
    GoalSent,
    Logged,
    RunEnded,
    RunStarted,
    StopRequested,
    Transitioned,
)
from engine.hot_change import ChangeReport
from engine.launch import Moment
from engine.messages import FramePoses, Quaternion, SceneDescription, Vector3, VisualGeometry
from engine.supervision import Supervision


@dataclass(frozen=True, kw_only=True)
class Finding:
    severity: str
    code: str
    message: str
    path: str = ""
    line: int = 1
    column: int = 1
    hint: str = ""


@dataclass(frozen=True, kw_only=True)
class Parameter:
    name: str
    schema: Mapping[str, object]
    required: bool = False


@dataclass(frozen=True, kw_only=True)
class Transition:
    source: str
    outcome: str
    target: str


@dataclass(frozen=True, kw_only=True)
class Node:
    path: str
    name: str
    kind: str
    title: str = ""
    outcomes: tuple[str, ...] = ()
    children: tuple[Node, ...] = ()
    transitions: tuple[Transition, ...] = ()
    initial: str | None = None
    conditions: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Behavior:
    id: str
    name: str
    description: str = ""
    errors: int = 0
    warnings: int = 0
    parameters: tuple[Parameter, ...] = ()
    findings: tuple[Finding, ...] = ()
    graph: Node | None = None
    view: Mapping[str, tuple[float, float]] = field(default_factory=dict[str, tuple[float, float]])
    success: tuple[str, ...] = ("finished",)


@dataclass(frozen=True, kw_only=True)
class Run:
    id: str
    behavior: str
    status: str
    started_at_s: float
    outcome: str | None = None
    success: bool = False
    cause: str = ""
    duration_s: float = 0.0


def state(path: str, title: str, *outcomes: str) -> Node:
    """Make a leaf."""
    return Node(path=path, name=path.rsplit("/", 1)[-1], kind="state", title=title, outcomes=outcomes)


def machine(path: str, children: tuple[Node, ...], arrows: str, *outcomes: str) -> Node:
    """Make a machine; arrows as `a.done>b b.done>finished`."""
    transitions = tuple(
        Transition(source=source, outcome=outcome, target=target)
        for source, outcome, target in (
            (*arrow.split(">")[0].split("."), arrow.split(">")[1]) for arrow in arrows.split()
        )
    )
    return Node(
        path=path,
        name=path.rsplit("/", 1)[-1],
        kind="machine",
        outcomes=outcomes,
        children=children,
        transitions=transitions,
        initial=children[0].name,
    )


def both(path: str, left: Node, right: Node, outcome: str) -> Node:
    """Make a concurrency container of two children that must both end with `outcome`."""
    return Node(
        path=path,
        name=path.rsplit("/", 1)[-1],
        kind="concurrency",
        outcomes=("finished", "failed"),
        children=(left, right),
        conditions=(
            f"finished: left={outcome} and right={outcome}",
            "failed: left=failed",
            "failed: right=failed",
        ),
    )


def _pick(path: str) -> Node:
    return machine(
        path,
        (
            state(f"{path}/descend", "motion.MoveLine", "reached", "failed"),
            state(f"{path}/grasp", "gripper.Grasp", "held", "empty"),
            state(f"{path}/lift", "motion.MoveLine", "reached", "failed"),
        ),
        "descend.reached>grasp descend.failed>failed grasp.held>lift grasp.empty>failed "
        "lift.reached>picked lift.failed>failed",
        "picked",
        "failed",
    )


def _move_both(path: str) -> Node:
    return both(
        path,
        state(f"{path}/left", "motion.MoveJoints", "reached", "failed"),
        state(f"{path}/right", "motion.MoveJoints", "reached", "failed"),
        "reached",
    )


def _transfer_graph() -> Node:
    steps = (
        _move_both("root/approach"),
        both("root/pick", _pick("root/pick/left"), _pick("root/pick/right"), "picked"),
        _move_both("root/carry"),
        both(
            "root/place",
            state("root/place/left", "gripper.Open", "opened", "failed"),
            state("root/place/right", "gripper.Open", "opened", "failed"),
            "opened",
        ),
        _move_both("root/home"),
    )
    arrows = (
        "approach.finished>pick approach.failed>failed pick.finished>carry pick.failed>failed "
        "carry.finished>place carry.failed>failed place.finished>home place.failed>failed "
        "home.finished>finished home.failed>failed"
    )
    return machine("root", steps, arrows, "finished", "failed")


TRANSFER = Behavior(
    id="behaviors/reconcycle/two_arm_transfer.yaml",
    name="two_arm_transfer",
    description="Both arms pick a part each and place it on the other's tray.",
    parameters=(
        Parameter(
            name="speed",
            schema={
                "type": "number",
                "title": "Speed",
                "description": "Share of the joint speed limits",
                "default": 0.5,
                "minimum": 0.05,
                "maximum": 1.0,
            },
        ),
        Parameter(
            name="lift_m",
            schema={
                "type": "number",
                "title": "Lift",
                "unit": "m",
                "description": "How far the parts are lifted off the tray",
                "default": 0.12,
                "minimum": 0.02,
                "maximum": 0.3,
            },
        ),
        Parameter(
            name="cycles",
            schema={
                "type": "integer",
                "title": "Cycles",
                "description": "How often the parts are swapped",
                "default": 1,
                "minimum": 1,
            },
        ),
        Parameter(
            name="order",
            schema={
                "enum": ["together", "left first", "right first"],
                "title": "Order",
                "description": "Which arm moves first",
                "default": "together",
            },
        ),
        Parameter(
            name="verify",
            schema={
                "type": "boolean",
                "title": "Verify the grasp",
                "description": "Check width and contact before lifting",
                "default": True,
            },
        ),
    ),
    graph=_transfer_graph(),
)
SINGLE = Behavior(
    id="behaviors/reconcycle/single_pick.yaml",
    name="single_pick",
    description="The left arm picks one part, and reports when nothing was between its fingers.",
    warnings=1,
    findings=(
        Finding(
            severity="warning",
            code="unused-parameter",
            message="parameter 'force_n' is declared and never used",
            line=6,
            column=3,
            hint="use it in an expression as ${force_n}, or remove it",
        ),
    ),
    parameters=(
        Parameter(
            name="part",
            schema={"type": "string", "title": "Part", "description": "Name of the stored entry", "minLength": 1},
            required=True,
        ),
    ),
    graph=machine(
        "root",
        (
            state("root/descend", "motion.MoveLine", "reached", "failed"),
            state("root/grasp", "gripper.Grasp", "held", "failed"),
            state("root/home", "motion.MoveJoints", "reached", "failed"),
        ),
        "descend.reached>grasp descend.failed>failed grasp.held>home grasp.failed>failed home.reached>finished "
        "home.failed>failed",
        "finished",
        "failed",
    ),
)
BROKEN = Behavior(
    id="behaviors/drafts/palletise.yaml",
    name="palletise",
    errors=1,
    findings=(
        Finding(
            severity="error",
            code="unknown-state",
            message="no state is named 'motion.MoveJoint'",
            path="root/approach",
            line=14,
            column=21,
            hint="did you mean motion.MoveJoints?",
        ),
    ),
)

NOTHING_HELD = Cause(
    message="the grasp failed: nothing between the pads",
    where="root/grasp",
    kind="GraspFailed",
    because=Cause(
        message="pads closed to 0.4 mm, expected at least 28 mm",
        where="left/gripper",
        kind="SkillFailed",
        because=Cause(message="no contact on either pad", where="cell/left_hand", kind="RobotError"),
    ),
)


class FakeBackend:
    """Implements `editor_web.backend.Backend`; leaves take `step_s`, `single_pick` fails at its grasp."""

    def __init__(self, *, step_s: float = 0.2, behaviors: tuple[Behavior, ...] = (BROKEN, SINGLE, TRANSFER)) -> None:
        self.cell_name = "dual_panda"
        self.known_bus: BusAccess | None = None
        self.step_s = step_s
        self._behaviors = {b.id: b for b in behaviors}
        self._runs: dict[str, Run] = {}
        self._events: dict[str, list[Event]] = {}
        self._began_s: dict[str, float] = {}
        self._visits: dict[tuple[str, str], int] = {}
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._callbacks: list[Callable[[str, Event], None]] = []
        self._topics: dict[str, object] = {"cell/scene": new_scene(), "cell/frames": frames_at(0.0)}
        self._topic_callbacks: dict[str, list[Callable[[object], None]]] = {}

    @property
    def bus(self) -> BusAccess:
        if self.known_bus is None:
            raise FlexcellError("this fake has no bus")
        return self.known_bus

    def behaviors(self) -> tuple[Behavior, ...]:
        return tuple(sorted(self._behaviors.values(), key=lambda b: b.id))

    def behavior(self, behavior_id: str) -> Behavior:
        if behavior_id not in self._behaviors:
            raise FlexcellError(f"no behavior {behavior_id!r}")
        return self._behaviors[behavior_id]

    def runs(self) -> tuple[Run, ...]:
        return tuple(reversed(self._runs.values()))

    def run(self, run_id: str) -> Run:
        if run_id not in self._runs:
            raise FlexcellError(f"no run {run_id!r}")
        return self._runs[run_id]

    async def start(
        self,
        behavior_id: str,
        *,
        parameters: Mapping[str, object],
        seed: int,
        inputs: Mapping[str, object] | None = None,
        supervision: Supervision | None = None,
        breakpoints: bool = False,
        begin: Moment | None = None,
    ) -> str:
        behavior = self.behavior(behavior_id)
        if behavior.graph is None:
            raise FlexcellError("the document has errors", where=behavior_id, hint="see its problems")
        if any(not task.done() for task in self._tasks.values()):
            raise FlexcellError("the cell is busy with another run", hint="stop it first")
        self._check(behavior, parameters)
        run_id = f"run-{len(self._runs) + 1:03d}"
        self._runs[run_id] = Run(id=run_id, behavior=behavior_id, status="running", started_at_s=time.time())
        self._events[run_id] = []
        self._began_s[run_id] = time.monotonic()
        self._tasks[run_id] = asyncio.create_task(self._play(run_id, behavior, dict(parameters), seed), name=run_id)
        return run_id

    async def stop(self, run_id: str, *, reason: str) -> None:
        run = self.run(run_id)
        if run.status != "running":
            return
        self._runs[run_id] = replace(run, status="stopping")
        self._emit(run_id, StopRequested, reason=reason)
        self._tasks[run_id].cancel()

    def subscribe(self, callback: Callable[[str, Event], None]) -> Callable[[], None]:
        self._callbacks.append(callback)
        return lambda: self._callbacks.remove(callback)

    def events(self, run_id: str, *, after: int = 0) -> list[Event]:
        self.run(run_id)
        return [e for e in self._events[run_id] if e.seq > after]

    def latest(self, topic: str) -> object | None:
        return self._topics.get(topic)

    def subscribe_topic(self, topic: str, callback: Callable[[object], None]) -> Callable[[], None]:
        callbacks = self._topic_callbacks.setdefault(topic, [])
        callbacks.append(callback)
        if topic in self._topics:
            callback(self._topics[topic])
        return lambda: callbacks.remove(callback)

    def control(self, run_id: str) -> Control:
        raise ControlError("this fake has no control", where=run_id)

    def operate(self, run_id: str) -> Attached:
        raise ControlError("this fake has no control", where=run_id)

    def change(self, run_id: str) -> ChangeReport:
        raise ControlError("this fake has no control", where=run_id)

    def interrupted(self) -> tuple[InterruptedRun, ...]:
        return ()

    async def resume(self, run_id: str, *, answers: Mapping[str, str] | None = None, changed: bool = False) -> str:
        raise ControlError("this fake resumes nothing", where=run_id)

    def publish(self, topic: str, message: object) -> None:
        """Publish on a topic."""
        self._topics[topic] = message
        for callback in list(self._topic_callbacks.get(topic, [])):
            callback(message)

    def emit(self, run_id: str, kind: type[Event], /, **fields: object) -> None:
        """Append one event to a run from outside."""
        self._runs.setdefault(run_id, Run(id=run_id, behavior=TRANSFER.id, status="running", started_at_s=time.time()))
        self._events.setdefault(run_id, [])
        self._began_s.setdefault(run_id, time.monotonic())
        self._emit(run_id, kind, **fields)

    def file(self, run_id: str, outcome: str) -> None:
        """Take a run that was emitted from outside as finished."""
        self._runs[run_id] = replace(self._runs[run_id], status="finished", outcome=outcome, success=True)

    def subscribers(self) -> tuple[Callable[[str, Event], None], ...]:
        """Who is told of events."""
        return tuple(self._callbacks)

    async def close(self) -> None:
        """Stop what still runs."""
        for task in self._tasks.values():
            task.cancel()
        await asyncio.gather(*self._tasks.values(), return_exceptions=True)

    @staticmethod
    def _check(behavior: Behavior, parameters: Mapping[str, object]) -> None:
        for parameter in behavior.parameters:
            value = parameters.get(parameter.name)
            if parameter.required and value in (None, ""):
                raise FlexcellError("a value is required", where=parameter.name, hint="name a stored entry")
            if value == "ghost":
                raise FlexcellError("no entry is named 'ghost'", where=parameter.name, hint="see the store")
            highest = parameter.schema.get("maximum")
            if isinstance(value, float | int) and isinstance(highest, float | int) and value > highest:
                raise FlexcellError(f"{value} is above the maximum {highest}", where=parameter.name)

    def _emit(self, run_id: str, kind: type[Event], /, **fields: object) -> None:
        events = self._events[run_id]
        event = kind(seq=len(events) + 1, time_s=time.monotonic() - self._began_s[run_id], **fields)
        events.append(event)
        for callback in list(self._callbacks):
            callback(run_id, event)

    async def _play(self, run_id: str, behavior: Behavior, parameters: dict[str, object], seed: int) -> None:
        assert behavior.graph is not None
        self._emit(
            run_id,
            RunStarted,
            behavior=behavior.name,
            document="sha256:0",
            parameters=parameters,
            seed=seed,
            clock="real",
        )
        motion = asyncio.create_task(self._move_arms(), name="arms")
        try:
            outcome = await self._node(run_id, behavior.graph)
            status = "finished"
        except asyncio.CancelledError:
            outcome, status = None, "stopped"
        finally:
            motion.cancel()
        cause = NOTHING_HELD if outcome == "failed" else None
        run = self._runs[run_id]
        self._runs[run_id] = replace(
            run,
            status=status,
            outcome=outcome,
            success=outcome == "finished",
            cause=cause.message if cause else "",
            duration_s=time.time() - run.started_at_s,
        )
        self._emit(run_id, RunEnded, status=status, outcome=outcome, cause=cause)

    async def _node(self, run_id: str, node: Node) -> str:
        visit = self._visits[run_id, node.path] = self._visits.get((run_id, node.path), 0) + 1
        self._emit(run_id, Entered, path=node.path, visit=visit, kind=node.kind, inputs={})
        try:
            match node.kind:
                case "machine":
                    outcome = await self._machine(run_id, node)
                case "concurrency":
                    await asyncio.gather(*(self._node(run_id, child) for child in node.children))
                    outcome = node.outcomes[0]
                case _:
                    outcome = await self._leaf(run_id, node)
        except asyncio.CancelledError:
            self._emit(run_id, Exited, path=node.path, visit=visit, outcome="preempted", preempted=True)
            raise
        cause = NOTHING_HELD if outcome == "failed" else None
        self._emit(run_id, Exited, path=node.path, visit=visit, outcome=outcome, cause=cause)
        return outcome

    async def _machine(self, run_id: str, node: Node) -> str:
        children = {child.name: child for child in node.children}
        name = node.initial or node.children[0].name
        while name in children:
            outcome = await self._node(run_id, children[name])
            arrow = next(t for t in node.transitions if (t.source, t.outcome) == (name, outcome))
            self._emit(run_id, Transitioned, path=node.path, source=name, outcome=outcome, target=arrow.target)
            name = arrow.target
        return name

    async def _leaf(self, run_id: str, node: Node) -> str:
        side = "right" if "right" in node.path else "left"
        goal = f"{run_id}:{node.path}"
        self._emit(
            run_id,
            GoalSent,
            path=node.path,
            goal=goal,
            address=f"{side}/{node.title.rsplit('.', 1)[-1]}",
            request={"speed": 0.5},
        )
        await asyncio.sleep(self.step_s * (1.25 if side == "right" else 1.0))
        fails = node.path == "root/grasp"
        status = "aborted" if fails else "succeeded"
        self._emit(run_id, GoalFinished, path=node.path, goal=goal, status=status)
        if node.name in ("grasp", "home"):
            self._emit(run_id, Logged, path=node.path, level="info", message="width 30.1 mm, force 19.8 N")
        return "failed" if fails else node.outcomes[0]

    async def _move_arms(self) -> None:
        began_s = time.monotonic()
        while True:
            self.publish("cell/frames", frames_at(time.monotonic() - began_s))
            await asyncio.sleep(1 / 30)


_ARMS = {"left": (-0.55, 1.0), "right": (0.55, -1.0)}


def new_scene() -> SceneDescription:
    """Make a table with two trays and two arms of boxes and cylinders."""
    geometries = [
        _box("table", "world", (1.6, 1.2, 0.04), (0.0, 0.0, -0.02), (0.72, 0.69, 0.64, 1.0)),
        _box("tray_north", "world", (0.36, 0.22, 0.02), (0.0, 0.28, 0.01), (0.25, 0.44, 0.56, 1.0)),
        _box("tray_south", "world", (0.36, 0.22, 0.02), (0.0, -0.28, 0.01), (0.56, 0.42, 0.25, 1.0)),
    ]
    for name in _ARMS:
        geometries += [
            VisualGeometry(
                name=f"{name}_base",
                frame=f"{name}/base",
                kind="cylinder",
                size_m=(0.08, 0.2),
                xyz=(0.0, 0.0, 0.1),
                rgba=(0.85, 0.86, 0.88, 1.0),
            ),
            _box(f"{name}_upper", f"{name}/upper", (0.09, 0.09, 0.4), (0.0, 0.0, 0.2), (0.9, 0.91, 0.93, 1.0)),
            _box(f"{name}_fore", f"{name}/fore", (0.07, 0.07, 0.4), (0.0, 0.0, 0.2), (0.2, 0.22, 0.26, 1.0)),
        ]
    return SceneDescription(geometries=tuple(geometries))


def frames_at(time_s: float) -> FramePoses:
    """Pose both arms, swinging from side to side."""
    rows: list[tuple[str, Vector3, Quaternion]] = []
    for name, (x, sign) in _ARMS.items():
        yaw = 0.5 * math.sin(1.5 * time_s + sign)
        lean = sign * (0.5 + 0.2 * math.sin(2.0 * time_s))
        rows.append((f"{name}/base", (x, 0.0, 0.0), (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))))
        upper = _turn(yaw, lean)
        rows.append((f"{name}/upper", (x, 0.0, 0.2), upper))
        elbow = (
            x + 0.4 * math.sin(lean) * math.cos(yaw),
            0.4 * math.sin(lean) * math.sin(yaw),
            0.2 + 0.4 * math.cos(lean),
        )
        rows.append((f"{name}/fore", elbow, _turn(yaw, lean + sign * 1.5)))
    return FramePoses(
        time_s=time_s,
        names=tuple(r[0] for r in rows),
        xyz=tuple(r[1] for r in rows),
        xyzw=tuple(r[2] for r in rows),
    )


def _turn(yaw: float, pitch: float) -> Quaternion:
    cy, sy, cp, sp = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
    return (-sy * sp, cy * sp, sy * cp, cy * cp)


def _box(
    name: str, frame: str, size_m: Vector3, xyz: Vector3, rgba: tuple[float, float, float, float]
) -> VisualGeometry:
    return VisualGeometry(name=name, frame=frame, kind="box", size_m=size_m, xyz=xyz, rgba=rgba)
