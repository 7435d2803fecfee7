"""What the main thread of a page is busy with: the tasks that the browser has run on it, by its own trace."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from playwright.sync_api import Browser, Page

_CATEGORIES = ["toplevel", "blink.user_timing"]
_TASK = "ThreadControllerImpl::RunTask"


@dataclass(frozen=True, kw_only=True)
class Task:
    """One turn of the main thread; `cpu_ms` is what it took itself, `wall_ms` includes waiting for a processor."""

    begin_us: float
    wall_ms: float
    cpu_ms: float

    @property
    def end_us(self) -> float:
        """When it was over, on the clock of the trace."""
        return self.begin_us + self.wall_ms * 1e3


@dataclass(frozen=True, kw_only=True)
class Recording:
    """Tasks of one page, and when its measures of one name started and ended."""

    tasks: tuple[Task, ...]
    measured: tuple[tuple[float, float], ...]

    def during(self) -> tuple[Task, ...]:
        """Return the tasks that overlap with what the page has measured."""
        return tuple(
            t for t in self.tasks if any(t.begin_us < end and t.end_us > begin for begin, end in self.measured)
        )


def start_recording(browser: Browser, page: Page) -> None:
    """Begin to trace a page; only one page of a browser can be."""
    browser.start_tracing(page=page, categories=_CATEGORIES)


def stop_recording(browser: Browser, *, measure: str) -> Recording:
    """End the trace; `measure` names the `performance.measure` of the page that matters."""
    events: list[dict[str, Any]] = json.loads(browser.stop_tracing())["traceEvents"]
    marks = [each for each in events if each["name"] == measure]
    main = {
        (e["pid"], e["tid"]) for e in events if e["name"] == "thread_name" and e["args"]["name"] == "CrRendererMain"
    }
    of_page = main & {(each["pid"], each["tid"]) for each in marks}
    tasks = (
        Task(begin_us=e["ts"], wall_ms=e["dur"] / 1e3, cpu_ms=e.get("tdur", 0.0) / 1e3)
        for e in events
        if e["name"] == _TASK and e["ph"] == "X" and (e["pid"], e["tid"]) in of_page
    )
    return Recording(tasks=tuple(tasks), measured=tuple(_spans(marks)))


def _spans(marks: list[dict[str, Any]]) -> Iterator[tuple[float, float]]:
    """Return when each measure started and ended; the two are events of the same id."""
    begun = {each["id2"]["local"]: float(each["ts"]) for each in marks if each["ph"] == "b"}
    for each in marks:
        if each["ph"] == "e":
            yield begun[each["id2"]["local"]], float(each["ts"])
