"""Shows a run on a terminal while it happens: one line a step on stderr."""

from __future__ import annotations

from rich.console import Console
from rich.markup import escape

from engine.cause_chain import describe_cause
from engine.event import (
    Event,
    FaultInjected,
    GoalFinished,
    MessageLogged,
    NodeEntered,
    NodeExited,
    NodeRetried,
    RunEnded,
    StopRequested,
)

_LEVELS = {"debug": "dim", "info": "default", "warning": "yellow", "error": "bold red"}


class ProgressPrinter:
    """Writes the events a person wants to see; hand `show` to `Run.watch`."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._started_s: dict[tuple[str, int], float] = {}

    def show(self, event: Event) -> None:
        """Write a line for an event, or nothing."""
        match event:
            case NodeEntered(kind="state"):
                self._started_s[event.path, event.visit] = event.time_s
            case NodeExited():
                self._exited(event)
            case MessageLogged():
                self._line(event, f"[{_LEVELS.get(event.level, 'default')}]{escape(event.message)}[/]", event.path)
            case FaultInjected():
                self._line(event, f"[magenta]{escape(f'{event.fault}: {event.detail}')}[/]", event.path)
            case NodeRetried():
                self._line(event, f"[yellow]again, attempt {event.attempt}[/]", event.path)
            case GoalFinished(status="aborted" | "rejected"):
                why = f": {describe_cause(event.cause)}" if event.cause else ""
                self._line(event, f"[red]{event.status}{escape(why)}[/]", event.path)
            case StopRequested():
                self._line(event, f"[yellow]stopping: {escape(event.reason)}[/]", "")
            case RunEnded():
                self._line(event, f"[bold]{event.status}[/] {escape(event.outcome or '')}", "")
            case _:
                pass

    def _exited(self, event: NodeExited) -> None:
        started_s = self._started_s.pop((event.path, event.visit), None)
        if started_s is None:
            return
        if event.preempted:
            what = "[yellow]preempted[/]"
        elif not event.outcome:
            what = "[red]error[/]"
        else:
            what = f"[{'red' if event.cause else 'green'}]{escape(event.outcome)}[/]"
        self._line(event, f"{what} [dim]after {event.time_s - started_s:.2f} s[/]", event.path)

    def _line(self, event: Event, text: str, path: str) -> None:
        place = f"{escape(path)}  " if path else ""
        self._console.print(f"[dim]{event.time_s:9.3f} s[/]  {place}{text}", soft_wrap=True, highlight=False)
