"""A recording has the measures that its topics tell, after the run and without its cell."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.clock import run_virtual
from engine.errors import RecordingError
from engine.recording import recorded_measures
from tests.engine.measures.published_arm import RADIUS_M, RATE_RAD_S, describe, place, press, turn
from tests.engine.replay.rig import record_run

TEXT = """
root:
  machine:
    initial: work
    states:
      work: {state: bench.Work, with: {for_s: 2}, transitions: {a: good, b: bad, c: bad}}
"""


def test_a_recorded_arm_is_measured_from_its_topics(tmp_path: Path) -> None:
    """What it publishes in a run comes out by the names of a simulated world."""

    def publish(bus: SkillBus) -> None:
        loop = asyncio.get_running_loop()
        describe(bus)
        for step in range(6):
            loop.call_later(step / 10, turn, bus, step / 10)
            loop.call_later(step / 10, place, bus, step / 10)
        loop.call_later(0.3, press, bus, 5.0, 0.3)

    run_virtual(record_run(TEXT, tmp_path / "r.mcap", rate_hz=50, prepare=publish))
    assert recorded_measures(tmp_path / "r.mcap") == {
        "left.path_m": pytest.approx(RADIUS_M * RATE_RAD_S * 0.5, rel=1e-3),
        "left.joint_path_rad": pytest.approx(RATE_RAD_S * 0.5),
        "left.speed_max_m_s": pytest.approx(RADIUS_M * RATE_RAD_S, rel=1e-3),
        "left.force_max_n": pytest.approx(5.0),
        "left.torque_max_nm": pytest.approx(0.3),
    }


def test_a_recording_without_arms_has_no_measures(tmp_path: Path) -> None:
    run_virtual(record_run(TEXT, tmp_path / "r.mcap", rate_hz=50))
    assert recorded_measures(tmp_path / "r.mcap") == {}


def test_another_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "r.mcap").write_text("a note", encoding="utf-8")
    with pytest.raises(RecordingError, match="not an MCAP file"):
        recorded_measures(tmp_path / "r.mcap")
