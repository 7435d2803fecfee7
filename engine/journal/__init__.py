"""The journal of runs: every event, durable before an effect leaves the engine.

`Journal.open(directory)` opens the SQLite journal and `begin` returns the journal of one run; `append` is a
cheap synchronous call, and `await commit()` returns when every appended event is on disk.
"""

from engine.journal.batch import WorldState
from engine.journal.codec import decode_event, encode_event, encode_event_log
from engine.journal.journal import Journal, SqliteRunJournal, journal_path
from engine.journal.journal_port import JournalPort, RunJournal, RunOrigin, RunRecord
from engine.journal.memory_journal import MemoryRunJournal
from engine.journal.null_journal import NullJournal, NullRunJournal
from engine.journal.reader import find_run, list_runs, read_events, read_origin, read_world
from engine.journal.snapshot import JournalSnapshot, open_snapshot

__all__ = [
    "Journal",
    "JournalPort",
    "JournalSnapshot",
    "MemoryRunJournal",
    "NullJournal",
    "NullRunJournal",
    "RunJournal",
    "RunOrigin",
    "RunRecord",
    "SqliteRunJournal",
    "WorldState",
    "decode_event",
    "encode_event",
    "encode_event_log",
    "find_run",
    "journal_path",
    "list_runs",
    "open_snapshot",
    "read_events",
    "read_origin",
    "read_world",
]
