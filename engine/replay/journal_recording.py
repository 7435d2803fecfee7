"""Converts a run of the journal to a recording that can be replayed, without topics of the bus."""

from __future__ import annotations

from typing import Literal, cast

from engine.errors import RecordingError
from engine.event import RunStarted
from engine.recording import RecordedDocuments, RecordedEvent, Recording, RecordingDescription
from engine.recording.recorded_run import RecordedRun
from engine.runtime.control import AutonomyLevel
from engine.runtime.run_options import RunOptions

_RESOLUTION_S = 1e-6
"""Events carry their times to the microsecond, and a journal has no other."""


def recording_from_journal(run: RecordedRun) -> Recording:
    """Return a journaled run as a recording.

    Raises:
        RecordingError: the journal does not hold its start.
    """
    started = run.events[0] if run.events else None
    if not isinstance(started, RunStarted):
        raise RecordingError(f"the journal does not hold the start of run {run.id}", where=run.place)
    origin = run.origin
    return Recording(
        path=run.place,
        description=RecordingDescription(
            run=run.id,
            behavior=started.behavior,
            document=started.document,
            behavior_file=origin.document,
            parameters=started.parameters,
            inputs=started.inputs,
            seed=started.seed,
            clock=cast("Literal['virtual', 'real']", started.clock),
            supervision=RunOptions(
                autonomy=cast("AutonomyLevel", origin.autonomy), demand_operator=origin.demand_operator
            ),
            started_unix_s=run.record.started_unix_s,
        ),
        documents=RecordedDocuments(
            behavior=origin.document, texts={name: text.encode() for name, text in origin.documents.items()}
        ),
        events=tuple(RecordedEvent(event, event.time_s) for event in run.events),
        resolution_s=_RESOLUTION_S,
    )
