"""The log of a run as a tree of activations, in which the order of branches at one instant does not count."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from engine.event import Event, NodeEntered, NodeExited
from tests.engine.reference.interpreter import Line


@dataclass
class Activation:
    """One activation of one node, with those inside it in the order in which they were entered."""

    path: str
    kind: str
    entered_s: float
    left_s: float = -1.0
    outcome: str = ""
    preempted: bool = False
    inside: list[Activation] = field(default_factory=list["Activation"])

    def lines(self, indent: str = "") -> list[str]:
        """Write it with everything inside, a line an activation."""
        how = self.outcome or "error"
        how = f"preempted{' ' + self.outcome if self.outcome else ''}" if self.preempted else how
        inside = sorted(self.inside, key=lambda a: a.path) if self.kind == "concurrency" else self.inside
        own = f"{indent}{self.path} {self.kind} {self.entered_s:g}..{self.left_s:g} {how}"
        return [own, *(line for activation in inside for line in activation.lines(f"{indent}  "))]


def lines_of(events: Iterable[Event]) -> list[Line]:
    """Return what a run's events say about entering and leaving."""
    lines: list[Line] = []
    for event in events:
        if isinstance(event, NodeEntered):
            lines.append(("+", event.time_s, event.path, event.kind, False))
        elif isinstance(event, NodeExited):
            lines.append(("-", event.time_s, event.path, event.outcome, event.preempted))
    return lines


def activation_lines(lines: Iterable[Line]) -> list[str]:
    """Write a log as its tree of activations.

    Raises:
        AssertionError: a node is entered while it is active, outside its container or after the end, or
            left while it is not active or before what is inside it.
    """
    outermost: list[Activation] = []
    active: dict[str, Activation] = {}
    for sign, time_s, path, what, preempted in lines:
        around = active.get(path.rpartition("/")[0])
        if sign == "+":
            assert path not in active, f"{path} is entered twice"
            assert around is not None or path == "root", f"{path} is entered outside its container"
            active[path] = Activation(path, what, time_s)
            (around.inside if around is not None else outermost).append(active[path])
        else:
            assert path in active, f"{path} is left without being active"
            left = active.pop(path)
            assert not any(inner.startswith(f"{path}/") for inner in active), f"{path} is left before what is inside"
            left.left_s, left.outcome, left.preempted = time_s, what, preempted
    assert not active, f"never left: {sorted(active)}"
    return [line for activation in outermost for line in activation.lines()]
