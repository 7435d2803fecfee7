"""The rinsing is killed, as by `kill -9`, on its way; another engine finds the arm where it stood and goes on.

The processes are those of `benchmarks/crash_recovery.py`, which kills at every event and commit.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from benchmarks.crash_trial import Trial
from engine.event import NodeExited
from tests.engine.cli.command import flexcell
from tests.engine.cli.process import events_in, run_id_in
from tests.tiers import nightly

ROOT = Path(__file__).parents[3]
BEHAVIOR = "behaviors/test_cylinder/test_cylinder.yaml"


@pytest.mark.nightly
def test_it_ends_with_the_cylinder_in_its_rack_wherever_it_is_killed(tmp_path: Path) -> None:
    """Judged by the behavior, which looks where the cylinder stands; what had ended is not done again."""
    file = tmp_path / "trials.json"
    command = [sys.executable, "-P", str(ROOT / "benchmarks" / "crash_recovery.py"), "--json", str(file)]
    done = subprocess.run(
        [*command, "--subject", "cylinder", "--every", "80"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    trials = msgspec.json.decode(file.read_bytes(), type=dict[str, list[Trial]])["cylinder"]
    assert len({trial.durable for trial in trials}) >= 3


@pytest.mark.parametrize(
    ("stage", "event"),
    [nightly("root/pick/grip", 39), ("root/water/rinse", 77)],
)
def test_flexcell_resume_goes_on_in_the_stage_it_was_killed_in(tmp_path: Path, stage: str, event: int) -> None:
    """No stage that had ended is done again, and none is left out."""
    (tmp_path / "crash.yaml").write_text(f"flexcell: 1\nfaults: [{{crash: {{at_event: {event}}}}}]\n", encoding="utf-8")
    killed = flexcell("run", ROOT / BEHAVIOR, "--clock", "virtual", "-q", "--faults", "crash.yaml", cwd=tmp_path)
    assert killed.code == -9
    before = ended(tmp_path)
    assert before[-1] != "root"
    assert stage not in before
    resumed = flexcell("resume", run_id_in(tmp_path), cwd=tmp_path)
    assert resumed.code == 0, resumed.err
    after = ended(tmp_path)
    assert after[: len(before)] == before
    assert stage in after
    assert sorted(after) == sorted(set(after))
    assert after[-1] == "root"


def ended(folder: Path) -> list[str]:
    """Return the paths of what the journal knows to have ended, in order."""
    return [event.path for event in events_in(folder) if isinstance(event, NodeExited)]
