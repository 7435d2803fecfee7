"""State of one run, as `RunReducer` reduces it from the events, and what each event changed."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy as shallow_copy
from typing import Literal

import msgspec

from engine.event import RunEnded
from engine.runtime.control.autonomy import AutonomyLevel


class PlanLive(msgspec.Struct, frozen=True, kw_only=True):
    """A path that a node has planned: arm, duration, length, planner, and planning time."""

    robot: str
    duration_s: float
    length_m: float
    found_by: str
    planning_s: float


class NodeLive(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One node: idle, active, done, failed, stopped or skipped.

    `visits` counts activations, so that a visit shorter than a frame is visible. Times are on the run's clock;
    `duration_s` is that of the last finished visit. `last_transition` is the last transition of a machine, as
    `source|outcome`. `taken` counts how often its machine has followed each outcome of this node, since the machine
    was entered; an undone node counts anew. `plan` is the last path that this visit planned.
    """

    status: str = "idle"
    visits: int = 0
    outcome: str = ""
    entered_s: float = 0.0
    duration_s: float = 0.0
    cause: str = ""
    last_transition: str = ""
    taken: Mapping[str, int] = {}
    plan: PlanLive | None = None


IDLE = NodeLive()
"""A node that was never entered."""
NodeStepKind = Literal["entered", "ended", "diverted", "skipped", "retried", "ticked", "transition", "preempts"]


class NodeStep(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """What one event did to a node: it was entered, skipped, diverted or ticked, ended, or waits for its next attempt.

    `name` is its outcome (empty for an error or a preemption; of a skipped node that by which it is passed over), the
    target of a diversion or the status of a tick. Of a `transition`, `path` is the child that was left and `name` its
    outcome; of a container that `preempts` branches, `name` is the condition. `by` is timeout, guard, on_error,
    operator or start. `children` are, where a container ended, the outcomes and targets of the children from which it
    had not proceeded. `before` is the node before.
    """

    kind: NodeStepKind
    path: str
    name: str = ""
    by: str = ""
    is_preempted: bool = False
    children: Mapping[str, str] = {}
    before: NodeLive = IDLE


class RunStateChange(msgspec.Struct, frozen=True, kw_only=True):
    """What one event changed: the changed nodes as they are now, and the step of the node that it is about.

    `run_changed` tells that the line of the run in lists (`RunView`) may have changed.
    """

    nodes: dict[str, NodeLive]
    step: NodeStep | None
    run_changed: bool

    @property
    def duration_s(self) -> float:
        """The duration of the node that the event ended; 0 where it ended none."""
        step = self.step
        return self.nodes[step.path].duration_s if step is not None and step.kind == "ended" else 0.0


UNCHANGED = RunStateChange(nodes={}, step=None, run_changed=False)
"""An event that changed nothing."""


class RunState:
    """State of one run up to event `seq`; only its `RunReducer` changes it."""

    def __init__(self, run: str = "") -> None:
        self.run = run
        self.seq = 0
        self.time_s = 0.0
        self.real_time = False
        self.seed = 0
        self.document = ""
        """The hash of the version that is executed."""
        self.parameters: dict[str, object] = {}
        self.end: RunEnded | None = None
        self.paused = False
        self.autonomy: AutonomyLevel | None = None
        self.locks: dict[str, str] = {}
        """The reason of each lock that an operator has set, by path."""
        self.stepping_back = ""
        """The state that an unfinished step back started to undo last; empty while there is none."""
        self.nodes: dict[str, NodeLive] = {}
        """Every node that an event is about."""
        self.active: dict[str, None] = {}
        """The nodes that were entered and not left, in order of entry."""
        self.exits: dict[str, dict[str, str]] = {}
        """The outcomes or targets of children from which their container has not proceeded, by its path and name."""
        self.containers: frozenset[str] = frozenset()
        """The paths that have nodes inside."""

    @property
    def ended(self) -> bool:
        """Whether the run is over."""
        return self.end is not None

    def node(self, path: str) -> NodeLive:
        """Return a node; idle where no event is about it."""
        return self.nodes.get(path, IDLE)

    def copy(self) -> RunState:
        """Return an independent copy."""
        copied = shallow_copy(self)
        copied.locks, copied.nodes, copied.active = dict(self.locks), dict(self.nodes), dict(self.active)
        copied.exits = {path: dict(ends) for path, ends in self.exits.items()}
        return copied
