"""The table of processor time: stages before the tests, kinds of tests, and rooms; nothing is counted twice."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

import bootstrap
from tests.cpu_times import LAST, OTHER, STAGES, room_of, table
from tests.tiers import ROOT

BUSY = "import time\nwhile time.process_time() < 0.3: pass"


@pytest.mark.parametrize(
    ("file", "room"),
    [
        ("tests/engine/document/test_loader.py", "fast engine/document"),
        ("tests/engine/stop/test_relay.py", "each engine/stop"),
        ("tests/robots/drivers/abb/test_egm_arm.py", "turn robots/drivers"),
        ("tests/robots/test_compiled.py", "fast robots"),
    ],
)
def test_a_room_is_a_folder_and_how_often_its_tests_are_run(file: str, room: str) -> None:
    assert (ROOT / file).is_file()
    assert room_of(file) == room


def test_what_is_no_test_and_no_stage_is_the_rest() -> None:
    stages, rooms = (
        {"set-up": 40.0, "types": 150.0},
        {"fast engine": 20.0, "turn robots": 60.0, LAST: 5.0, "fast x": 1.0},
    )
    assert table(stages, rooms, total_s=300.0) == [
        "   40.0  set-up",
        "  150.0  types",
        "   60.0  tests: turn",
        "   21.0  tests: fast",
        f"    5.0  {LAST}",
        f"   24.0  {OTHER}",
        "  300.0  all",
        "   60.0  turn robots",
        "   20.0  fast engine",
        "    1.0  fast x",
    ]


def test_a_run_prints_its_table_before_its_last_line() -> None:
    """Also of tests that run in other processes."""
    test = "tests/house/test_tiers.py"
    command = [sys.executable, "-P", "-m", "pytest", "-q", "--cpu", "-n", "1", "-p", "no:cacheprovider", test]
    environment = {**os.environ, STAGES: '{"types": 7.5}'}
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=100, env=environment, check=False)
    assert done.returncode == 0, done.stdout
    lines = done.stdout.splitlines()
    assert "    7.5  types" in lines
    assert any(line.endswith("  each house") for line in lines)
    assert any(f"  {test}::" in line for line in lines)
    assert "passed" in lines[-1]


def test_a_stage_has_the_time_of_its_commands() -> None:
    spent: dict[str, float] = {}
    with bootstrap._measured("busy", spent):  # pyright: ignore[reportPrivateUsage]
        subprocess.run([sys.executable, "-c", BUSY], check=True)
    with bootstrap._measured("idle", spent):  # pyright: ignore[reportPrivateUsage]
        sum(range(1_000_000))
    assert spent["busy"] > 0.2
    assert spent["idle"] < 0.01
