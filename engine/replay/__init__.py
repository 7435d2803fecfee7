"""Deterministic re-execution of a recorded run: its results stand in for the robots, its events are compared.

`replay(load_recording(path), load_states())` runs it; `report.difference` is the first difference.
"""

from engine.replay.difference import Difference
from engine.replay.journaled import recording_of
from engine.replay.replaying import ReplayReport, replay

__all__ = ["Difference", "ReplayReport", "recording_of", "replay"]
