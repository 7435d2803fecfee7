"""Prints the progress of a run on stderr, one line per step."""

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
    """Prints the events that matter to a person; pass `show` to `Run.watch`."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._started_s: dict[tuple[str, int], float] = {}

    def show(self, event: Event) -> None:
        """Print a line for an event, or nothing."""
        match event:
            case NodeEntered(kind="state"):
                self._started_s[event.path, event.visit] = event.time_s
            case NodeExited():
                self._show_exit(event)
            case MessageLogged():
                self._print_line(
                    event, f"[{_LEVELS.get(event.level, 'default')}]{escape(event.message)}[/]", event.path
                )
            case FaultInjected():
                self._print_line(event, f"[magenta]{escape(f'{event.fault}: {event.detail}')}[/]", event.path)
            case NodeRetried():
                self._print_line(event, f"[yellow]retry, attempt {event.attempt}[/]", event.path)
            case GoalFinished(status="aborted" | "rejected"):
                why = f": {describe_cause(event.cause)}" if event.cause else ""
                self._print_line(event, f"[red]{event.status}{escape(why)}[/]", event.path)
            case StopRequested():
                self._print_line(event, f"[yellow]stopping: {escape(event.reason)}[/]", "")
            case RunEnded():
                self._print_line(event, f"[bold]{event.status}[/] {escape(event.outcome or '')}", "")
            case _:
                pass

    def _show_exit(self, event: NodeExited) -> None:
        started_s = self._started_s.pop((event.path, event.visit), None)
        if started_s is None:
            return
        if event.preempted:
            end = "[yellow]preempted[/]"
        elif not event.outcome:
            end = "[red]error[/]"
        else:
            end = f"[{'red' if event.cause else 'green'}]{escape(event.outcome)}[/]"
        self._print_line(event, f"{end} [dim]after {event.time_s - started_s:.2f} s[/]", event.path)

    def _print_line(self, event: Event, text: str, path: str) -> None:
        node = f"{escape(path)}  " if path else ""
        self._console.print(f"[dim]{event.time_s:9.3f} s[/]  {node}{text}", soft_wrap=True, highlight=False)
