"""Where the processor time of a run of the tests goes: `pytest --cpu` prints a table of stages and rooms at its end."""

from __future__ import annotations

import json
import os
from collections import defaultdict
from collections.abc import Generator, Iterable, Mapping
from typing import cast

import pytest

from tests.tiers import ROOT, kinds_of
from tests.turns import takes_turns

STAGES = "FLEXCELL_CPU_STAGES"
"""The environment variable with what came before the tests, as JSON: names of stages, each with its seconds."""
SPENT = "cpu_s"
"""The property of a report: seconds of processor time from the beginning of a test to the end of its teardown."""
LAST = "last tests of each process, with what all share: the browser, the server of commands"
OTHER = "reading tests, reporting"
LINES = 30
NAMED_S = 0.1
"""What a single test must cost to be in the table."""


def spent_s() -> float:
    """Return the processor time of this process, with all that it started and that has ended, in seconds."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def room_of(file: str) -> str:
    """Return who shares the time of a file of tests: `fast robots/arm`, `each robots/sim`, `turn editor_web`.

    `fast` needs no browser, process or physics, `each` needs one and is in each turn, `turn` takes turns.
    """
    path = ROOT / file
    kind = "turn" if takes_turns(path) else "each" if kinds_of(path) else "fast"
    folders = file.split("/")[1:-1][:2] or [file]
    return f"{kind} {'/'.join(folders)}"


class CpuTimes:
    """Measures each test where it runs, and adds up by rooms where reports arrive."""

    def __init__(self) -> None:
        self._began_s = 0.0
        self._is_last = False
        self.rooms: defaultdict[str, float] = defaultdict(float)
        self.tests: defaultdict[str, float] = defaultdict(float)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_protocol(
        self, item: pytest.Item, nextitem: pytest.Item | None
    ) -> Generator[None, object, object]:
        """Note when a test begins."""
        self._began_s, self._is_last = spent_s(), nextitem is None
        return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item, call: pytest.CallInfo[None]
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        """Add what was spent to the last report of a test."""
        report = yield
        if call.when == "teardown":
            room = LAST if self._is_last else room_of(item.nodeid.partition("::")[0])
            report.user_properties.append((SPENT, [room, spent_s() - self._began_s]))
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Take what a test has spent, from whichever process."""
        for name, value in report.user_properties:
            if name == SPENT:
                room, seconds = cast("tuple[str, float]", value)
                self.rooms[room] += seconds
                self.tests[report.nodeid] += seconds

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Print the table."""
        terminalreporter.section("CPU seconds")
        stages = json.loads(os.environ.get(STAGES, "{}"))
        costly = [(name, seconds) for name, seconds in costliest(self.tests) if seconds >= NAMED_S]
        for line in (*table(stages, self.rooms, total_s=spent_s()), "", *lines_of(costly)):
            terminalreporter.line(line)


def table(stages: Mapping[str, float], rooms: Mapping[str, float], *, total_s: float) -> list[str]:
    """Return the lines: stages in their order, kinds of tests, and the rooms that cost most.

    Args:
        stages: Seconds of what came before the tests.
        rooms: Seconds of the tests by room, as `room_of` names them.
        total_s: All that was spent, the stages included.
    """
    kinds: defaultdict[str, float] = defaultdict(float)
    for room, seconds in rooms.items():
        kinds[room if room == LAST else f"tests: {room.partition(' ')[0]}"] += seconds
    rest_s = total_s - sum(stages.values()) - sum(rooms.values())
    parts = [*stages.items(), *costliest(kinds), (OTHER, rest_s), ("all", total_s)]
    most = [(room, seconds) for room, seconds in costliest(rooms) if room != LAST]
    return lines_of((*parts, *most))


def costliest(seconds: Mapping[str, float]) -> list[tuple[str, float]]:
    """Return the first in the order of what they cost."""
    return sorted(seconds.items(), key=lambda each: -each[1])[:LINES]


def lines_of(seconds: Iterable[tuple[str, float]]) -> list[str]:
    """Return a line for each name."""
    return [f"{spent:7.1f}  {name}" for name, spent in seconds]
