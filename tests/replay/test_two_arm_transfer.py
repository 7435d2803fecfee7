"""The recorded transfer runs again without its simulation, and a changed one is caught with both sides named.

The recording itself is a test of its own, collected by the pytest plugin from this folder. When
what happens in the transfer changes on purpose: `python tests/replay/make_recordings.py`.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
from pathlib import Path

from engine.document import load_behavior
from engine.recording import load_recording, recorded_behavior
from tests.engine.cli.command import flexcell

FOLDER = Path(__file__).parent
PROJECT = FOLDER.parents[1]
RECORDING = FOLDER / "two_arm_transfer.mcap"
BEHAVIOR = PROJECT / "behaviors" / "reconcycle" / "two_arm_transfer.yaml"
AGAIN = "make it again: python tests/replay/make_recordings.py"
SIMULATION = ("mujoco", "numpy", "scipy", "pinocchio", "ruckig", "robots.sim", "robots.model", "robots.arm")
REPLAY = f"""
import json, sys
from engine.cli.main import main
sys.argv = ["flexcell", "replay", "--json", sys.argv[1]]
try:
    main()
finally:
    print(json.dumps([name for name in {SIMULATION!r} if name in sys.modules]))
"""


def test_the_transfer_runs_again_within_two_seconds_and_without_its_simulation() -> None:
    """Measured as processor time with the start of the process: the machine may have other things to do."""
    before_s = _children_s()
    done = subprocess.run(
        [sys.executable, "-c", REPLAY, RECORDING], cwd=PROJECT, capture_output=True, text=True, timeout=100, check=False
    )
    used_s = _children_s() - before_s
    told, imported = (json.loads(line) for line in done.stdout.splitlines())
    (row,) = told["replays"]
    assert (done.returncode, row["status"], row["events"] > 200) == (0, "same", True), f"{row}; {AGAIN}"
    assert imported == []
    assert used_s < 2.0


def test_one_changed_transition_is_caught_with_its_path_and_both_sides(tmp_path: Path) -> None:
    changed = tmp_path / "changed.yaml"
    text = BEHAVIOR.read_text(encoding="utf-8")
    old, new = "transitions: {held: load, missed: failed", "transitions: {held: home, missed: failed"
    changed.write_text(text.replace(old, new, 1), encoding="utf-8")
    said = flexcell("replay", RECORDING, "--behavior", changed, cwd=PROJECT)
    assert said.code == 4
    first = said.err.splitlines()[0]
    assert "root/transfer/left: recorded `grasp —held→ load`" in first
    assert "replayed `grasp —held→ home`" in first


def test_the_recording_is_small_and_that_of_the_present_behavior() -> None:
    assert RECORDING.stat().st_size < 300_000
    recording = load_recording(RECORDING)
    assert recorded_behavior(recording.documents).meaning == load_behavior(BEHAVIOR).meaning, AGAIN
    assert (recording.description.clock, recording.description.seed) == ("virtual", 1)
    assert sorted(recording.documents.texts) == [
        "cells/dual_panda.yaml",
        "entries/dual_panda.yaml",
        "reconcycle/two_arm_transfer.yaml",
    ]


def _children_s() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
