"""Tests of behaviors: run one headless in virtual time, replay a recording.

With pytest all of it comes by itself, see `engine.pytest_plugin`.
"""

from engine.document.substitutes import Ending
from engine.testing.behavior import Ran, RunBehavior, run_behavior
from engine.testing.replaying import ReplayFile, replay_file

__all__ = ["Ending", "Ran", "ReplayFile", "RunBehavior", "replay_file", "run_behavior"]
