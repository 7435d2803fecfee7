"""Behaviors and runs as the dashboard sees them, made by hand: one of two arms, one that fails, one that is broken."""

from __future__ import annotations

from engine.document.nodes.node_kinds import node_icon
from engine.errors import Cause
from engine.library.behavior_graph import GraphNode, GraphTransition
from engine.library.behavior_library import BehaviorView, FindingView, ParameterView

SUCCESS = ("finished",)


def parameter(name: str, schema: dict[str, object], *, required: bool = False) -> ParameterView:
    """Make a parameter."""
    return ParameterView(name=name, schema=schema, required=required)


def node(
    path: str,
    kind: str,
    *outcomes: str,
    title: str = "",
    children: tuple[GraphNode, ...] = (),
    transitions: tuple[GraphTransition, ...] = (),
    initial: str | None = None,
    conditions: tuple[str, ...] = (),
) -> GraphNode:
    """Make a node."""
    return GraphNode(
        path=path,
        name=path.rsplit("/", 1)[-1],
        kind=kind,
        icon=node_icon(kind),
        title=title,
        description="",
        outcomes=outcomes,
        children=children,
        transitions=transitions,
        initial=initial,
        conditions=conditions,
    )


def state(path: str, title: str, *outcomes: str) -> GraphNode:
    """Make a leaf."""
    return node(path, "state", *outcomes, title=title)


def machine(path: str, children: tuple[GraphNode, ...], arrows: str, *outcomes: str) -> GraphNode:
    """Make a machine; arrows as `a.done>b b.done>finished`."""
    transitions = tuple(
        GraphTransition(source=source, outcome=outcome, target=target)
        for source, outcome, target in (
            (*arrow.split(">")[0].split("."), arrow.split(">")[1]) for arrow in arrows.split()
        )
    )
    initial = children[0].name
    return node(path, "machine", *outcomes, children=children, transitions=transitions, initial=initial)


def both(path: str, left: GraphNode, right: GraphNode, outcome: str) -> GraphNode:
    """Make a concurrency container of two children that must both end with `outcome`."""
    conditions = (f"finished: left={outcome} and right={outcome}", "failed: left=failed", "failed: right=failed")
    return node(path, "concurrency", "finished", "failed", children=(left, right), conditions=conditions)


def _pick(path: str) -> GraphNode:
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


def _move_both(path: str) -> GraphNode:
    return both(
        path,
        state(f"{path}/left", "motion.MoveJoints", "reached", "failed"),
        state(f"{path}/right", "motion.MoveJoints", "reached", "failed"),
        "reached",
    )


def _transfer_graph() -> GraphNode:
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


TRANSFER = BehaviorView(
    id="behaviors/reconcycle/two_arm_transfer.yaml",
    name="two_arm_transfer",
    success=SUCCESS,
    description="Both arms pick a part each and place it on the other's tray.",
    parameters=(
        parameter(
            "speed",
            {
                "type": "number",
                "title": "Speed",
                "description": "Share of the joint speed limits",
                "default": 0.5,
                "minimum": 0.05,
                "maximum": 1.0,
            },
        ),
        parameter(
            "lift_m",
            {
                "type": "number",
                "title": "Lift",
                "unit": "m",
                "description": "How far the parts are lifted off the tray",
                "default": 0.12,
                "minimum": 0.02,
                "maximum": 0.3,
            },
        ),
        parameter(
            "cycles",
            {
                "type": "integer",
                "title": "Cycles",
                "description": "How often the parts are swapped",
                "default": 1,
                "minimum": 1,
            },
        ),
        parameter(
            "order",
            {
                "enum": ["together", "left first", "right first"],
                "title": "Order",
                "description": "Which arm moves first",
                "default": "together",
            },
        ),
        parameter(
            "verify",
            {
                "type": "boolean",
                "title": "Verify the grasp",
                "description": "Check width and contact before lifting",
                "default": True,
            },
        ),
    ),
    graph=_transfer_graph(),
)
SINGLE = BehaviorView(
    id="behaviors/reconcycle/single_pick.yaml",
    name="single_pick",
    success=SUCCESS,
    description="The left arm picks one part, and reports when nothing was between its fingers.",
    findings=(
        FindingView(
            severity="warning",
            code="unused-parameter",
            message="parameter 'force_n' is declared and never used",
            path="",
            line=6,
            column=3,
            hint="use it in an expression as ${force_n}, or remove it",
        ),
    ),
    parameters=(
        parameter(
            "part",
            {"type": "string", "title": "Part", "description": "Name of the stored entry", "minLength": 1},
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
BROKEN = BehaviorView(
    id="behaviors/drafts/palletise.yaml",
    name="palletise",
    description="",
    success=SUCCESS,
    findings=(
        FindingView(
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
