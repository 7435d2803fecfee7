"""Tests of behaviors: run one headless in virtual time, replay a recording.

The pytest plugin `engine.pytest_plugin` provides both automatically.
"""

from engine.document.substitutes import SubstituteEnding
from engine.testing.behavior_run import BehaviorRunner, CompletedRun, run_behavior
from engine.testing.recording_replay import RecordingReplayer, replay_file

__all__ = ["BehaviorRunner", "CompletedRun", "RecordingReplayer", "SubstituteEnding", "replay_file", "run_behavior"]
