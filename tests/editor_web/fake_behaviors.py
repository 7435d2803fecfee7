"""Behaviors and runs as the dashboard sees them, made by hand: one of two arms, one that fails, one that is broken."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.event import Cause
from engine.runtime.control import ControlView


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
    control: ControlView | None = None


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
