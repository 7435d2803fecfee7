"""Deterministic re-execution of a recorded run: recorded results replace the robots, and events are compared.

`replay(load_recording(path), load_states())` runs it; `report.difference` is the first difference.
"""

from engine.replay.journal_recording import recording_from_journal
from engine.replay.replay_difference import ReplayDifference
from engine.replay.replayer import ReplayReport, replay
from engine.replay.value_change import ValueChange, value_changes

__all__ = ["ReplayDifference", "ReplayReport", "ValueChange", "recording_from_journal", "replay", "value_changes"]
