"""Prints the progress of a run on stderr, one line per step."""

from __future__ import annotations

from rich.console import Console
from rich.markup import escape

from engine.cause_chain import describe_cause
from engine.event import Event, GoalFinished
from engine.runtime.history.event_texts import event_text
from engine.runtime.history.run_reducer import RunReducer
from engine.runtime.history.run_state import RunStateChange

_STYLES = {"debug": "dim", "info": "default", "warning": "yellow", "error": "bold red"}
_ALWAYS = frozenset({"log", "fault", "retry", "stop", "run_ended"})
"""The tags of the events that matter to a person; besides, states that end and goals that fail do."""


class ProgressPrinter:
    """Prints the events that matter to a person; pass `show` to `Run.watch`."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._reducer = RunReducer()

    def show(self, event: Event) -> None:
        """Print a line for an event, or nothing."""
        change = self._reducer.apply(event)
        if change is not None and (_is_important(event) or self._ends_state(change)):
            self._print_line(event, change)

    def _ends_state(self, change: RunStateChange) -> bool:
        step = change.step
        if step is None or step.kind != "ended" or step.before.status != "active":
            return False
        return step.path not in self._reducer.state.containers

    def _print_line(self, event: Event, change: RunStateChange) -> None:
        shown = event_text(event, duration_s=change.duration_s)
        node = f"{escape(shown.path)}  " if shown.path else ""
        # The causes of a node are printed once, with the result of the run.
        why = f": {describe_cause(shown.cause)}" if shown.cause is not None and isinstance(event, GoalFinished) else ""
        style = "green" if change.step is not None and shown.level == "info" else _STYLES.get(shown.level, "default")
        line = f"[dim]{event.time_s:9.3f} s[/]  {node}[{style}]{escape(shown.text + why)}[/]"
        self._console.print(line, soft_wrap=True, highlight=False)


def _is_important(event: Event) -> bool:
    if isinstance(event, GoalFinished):
        return event.status in ("aborted", "rejected")
    return event.__struct_config__.tag in _ALWAYS
