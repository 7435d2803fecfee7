"""Runs a tree written in a test in virtual time and returns what came of it."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from textwrap import dedent, indent

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.event import Event, MessageLogged, NodeDiverted, NodeEntered, NodeExited, NodeRetried, StatusChanged
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from tests.engine.runtime.tree.scripted_states import CATALOGUE, COUNTS

HEAD = "flexcell: 1\nname: test\noutcomes: [success, failure]\nsuccess: [success]\n"


@dataclass(frozen=True)
class ObservedRun:
    """A run's result and its events."""

    result: RunResult
    events: tuple[Event, ...]

    @property
    def lines(self) -> list[str]:
        """What happened to leaves, with its time: `1 +path`, `2 -path outcome`, `2 !path message`."""
        return [line for event in self.events if (line := _line(event))]

    @property
    def statuses(self) -> list[str]:
        """What happened to composites and decorators: `1 path status`."""
        return [f"{e.time_s:g} {_short(e.path)} {e.status}" for e in self.events if isinstance(e, StatusChanged)]

    @property
    def why(self) -> list[str]:
        """The messages of the cause chain, outermost first."""
        return [link.message for link in self.result.cause.chain()] if self.result.cause is not None else []

    def entered(self, name: str) -> list[float]:
        """Return when the leaf whose path ends so was entered."""
        return [e.time_s for e in self.events if isinstance(e, NodeEntered) and e.path.endswith(f"/{name}")]


def _short(path: str) -> str:
    return path.removeprefix("root/")


def _line(event: Event) -> str:
    at = f"{event.time_s:g}"
    match event:
        case NodeEntered() if event.kind == "state":
            return f"{at} +{_short(event.path)}"
        case NodeExited() if event.path != "root":
            return f"{at} -{_short(event.path)} {'preempted' if event.preempted else event.outcome or 'error'}"
        case MessageLogged():
            return f"{at} !{_short(event.path)} {event.message}"
        case NodeDiverted():
            return f"{at} ~{_short(event.path)} {event.by} {event.target}"
        case NodeRetried():
            return f"{at} *{_short(event.path)} {event.attempt}"
        case _:
            return ""


def tree_plan(tree: str, *, head: str = "") -> Plan:
    """Plan a document whose root is the tree given."""
    text = f"{HEAD}{dedent(head)}\nroot:\n  tree:\n{indent(dedent(tree), '    ')}\n"
    return new_plan(parse_behavior(text, file="test.yaml"), CATALOGUE)


def run_tree(tree: str, *, head: str = "", stop_at_s: float | None = None, instant_limit: int = 10_000) -> ObservedRun:
    """Run a tree to its end in virtual time."""
    return run_plan(
        tree_plan(tree, head=head), stop_at_s=() if stop_at_s is None else (stop_at_s,), instant_limit=instant_limit
    )


def run_plan(
    plan: Plan,
    *,
    stop_at_s: Iterable[float] = (),
    instant_limit: int = 10_000,
    counts: Mapping[str, int] | None = None,
) -> ObservedRun:
    """Run a plan to its end in virtual time; `counts` are activations that scripted leaves have behind them."""
    COUNTS.clear()
    COUNTS.update(counts or {})
    events: list[Event] = []

    async def main() -> RunResult:
        run = Run(plan, run="r", bus=SkillBus(new_clock()), instant_limit=instant_limit)
        run.watch(events.append)
        for at_s in stop_at_s:
            asyncio.get_running_loop().call_later(at_s, run.stop, "test")
        return await run.execute()

    return ObservedRun(run_virtual(main()), tuple(events))
