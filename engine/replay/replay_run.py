"""One replay of a recorded run, on its own loop, up to its end or its first difference."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Mapping, Sequence

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.errors import ControlError
from engine.event import (
    Event,
    MessageLogged,
    OperatorChanged,
    OperatorCommanded,
    PauseConfirmed,
    RunStarted,
    StopRequested,
)
from engine.journal import MemoryRunJournal
from engine.recording import RecordedEvent, Recording
from engine.replay.entry_schedule import RecordedEntrySchedule
from engine.replay.event_comparison import EventComparison, PathOrderComparison, TotalOrderComparison
from engine.replay.expected_events import Intervention, interventions, is_replayed
from engine.replay.operator_actions import apply_intervention, require_known
from engine.replay.recorded_requests import RecordedRequests
from engine.replay.recorded_schedule import RecordedSchedule
from engine.replay.replay_difference import ReplayDifference
from engine.replay.replay_loop import ReplayLoop
from engine.replay.replay_port import ReplayPort
from engine.runtime.plan import Plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult

_PATIENCE_S = 10.0
"""Time after the last recorded event beyond which a run on the virtual clock counts as stuck."""
_REAL_PATIENCE_S = 3600.0
NO_VERSIONS: Mapping[int, Plan] = {}
_BEFORE = (RunStarted, StopRequested, OperatorCommanded, OperatorChanged, PauseConfirmed, MessageLogged)
"""What can be expected before its first node."""


class ReplayRun:
    """One replay; `run` it on a `ReplayLoop`.

    Args:
        recording: What was recorded.
        plan: The behavior to run.
        expected: The events to come again.
        turns: By how many turns of the loop answers come later within their instant, by place.
        versions: What took over in hot changes, by the number of the event.
    """

    def __init__(
        self,
        recording: Recording,
        plan: Plan,
        expected: Sequence[RecordedEvent],
        turns: Mapping[int, int],
        versions: Mapping[int, Plan] = NO_VERSIONS,
    ) -> None:
        self._versions = versions
        self._recording = recording
        self._plan = plan
        self._expected = expected
        self.turns = turns
        self._exact = recording.description.clock == "virtual"
        self._interventions = tuple(interventions(expected, recording.description.supervision))
        for each in self._interventions:
            require_known(each.event)
        self._comparison: EventComparison = (
            TotalOrderComparison(expected) if self._exact else PathOrderComparison(expected)
        )
        self.difference: ReplayDifference | None = None
        self.events: list[Event] = []
        self._commands: deque[Intervention] = deque()
        self._commanding = False
        self._over = False

    @property
    def same(self) -> bool:
        """Whether all recorded events occurred and no others."""
        return self.difference is None

    @property
    def met(self) -> int:
        """Number of equal events."""
        return self._comparison.met

    async def run(self) -> RunResult:
        """Execute the replay to its end or to the first difference."""
        loop = asyncio.get_running_loop()
        assert isinstance(loop, ReplayLoop)
        description = self._recording.description
        self._timetable = RecordedSchedule(
            loop,
            by_place=self._exact,
            resolution_s=self._recording.resolution_s,
            turns=self.turns,
            until_s=self._expected[-1].at_s + (_PATIENCE_S if self._exact else _REAL_PATIENCE_S),
            on_standstill=self._stand_still,
        )
        self._port = ReplayPort(
            RecordedRequests(self._expected), RecordedEntrySchedule(self._expected, self._timetable), self._timetable
        )
        self._run = Run(
            self._plan,
            run=description.run,
            bus=SkillBus(new_clock()),
            parameters=description.parameters,
            inputs=description.inputs,
            seed=description.seed,
            skills=self._port,
            journal=MemoryRunJournal(run_id=description.run),
            supervision=description.supervision,
        )
        self._run.watch(self._take)
        loop.attach(self._timetable)
        try:
            self._intervene_first()
            result = await self._run.execute()
        finally:
            loop.detach(self._timetable)
        if self.difference is None and self._recording.complete:
            self.difference = self._comparison.missing("the replay has ended")
        return result

    def _intervene_first(self) -> None:
        """Do at once what was done before the first node was performed; the rest when it is due."""
        begun = (place for place, each in enumerate(self._expected) if not isinstance(each.event, _BEFORE))
        first = next(begun, len(self._expected))
        for each in self._interventions:
            if each.place > first:
                self._timetable.expect(each.place, each.at_s, lambda each=each: self._command(each))
        for each in self._interventions:
            if each.place < first:
                self._commands.append(each)
        self._do_commands()

    def _command(self, each: Intervention) -> None:
        self._commands.append(each)
        if not self._commanding:
            # In a step of its own: what is done from outside never comes in the middle of an event.
            self._commanding = True
            asyncio.get_running_loop().call_soon(self._do_commands)

    def _do_commands(self) -> None:
        """Do what is due, and what becomes due by that: it was done in one go."""
        self._commanding = True
        while self._commands:
            try:
                apply_intervention(self._run, self._commands.popleft(), self._versions)
            except ControlError:
                # The run is not where it was when this was commanded; that the command is missing is the difference.
                continue
        self._commanding = False

    def _take(self, event: Event) -> None:
        self.events.append(event)
        if self._over or not is_replayed(event):
            return
        found = self._comparison.take(event)
        if found is not None:
            self._end(found)
        elif self._comparison.done and not self._recording.complete:
            self._end(None)
        else:
            self._timetable.count()

    def _stand_still(self) -> None:
        lacks = "which the recording does not have"
        waiting = "; ".join(f"{path} waits for {what}, {lacks}" for path, what in self._port.waiting.items())
        self._end(self._comparison.missing(waiting or "nothing can happen any more"))

    def _end(self, difference: ReplayDifference | None) -> None:
        if self._over:
            return
        self._over = True
        self.difference = difference
        self._port.abort()
        asyncio.get_running_loop().call_soon(self._run.stop, "the replay is over")
