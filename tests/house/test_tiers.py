"""Tests are marked by what they need, so that a fast run leaves out all that drive browsers, processes and physics."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.tiers import ROOT, kinds_of


@pytest.mark.parametrize(
    ("file", "kind"),
    [
        ("tests/editor_web/test_page.py", "browser"),
        ("tests/engine/journal/test_journal_durability.py", "process"),
        ("tests/engine/cli/commands/test_check.py", "process"),
        ("tests/robots/arm/test_arm_in_physics.py", "physics"),
        ("tests/editor_web/cell_view/test_cell_view_of_real_cells.py", "physics"),
        ("tests/engine/testing/test_testing_how_to.py", "physics"),
        ("tests/robots/test_simulated_cell.py", "physics"),
    ],
)
def test_a_file_has_the_markers_of_what_it_and_its_helpers_import(file: str, kind: str) -> None:
    """By itself: nobody has to think of it."""
    assert kind in kinds_of(ROOT / file)


@pytest.mark.parametrize(
    "file", ["tests/engine/document/test_loader.py", "tests/house/test_locks.py", "tests/replay/two_arm_transfer.mcap"]
)
def test_other_files_have_none(file: str) -> None:
    """They are what a fast run is made of."""
    assert kinds_of(ROOT / file) == frozenset()


def test_every_file_that_asks_for_a_browser_is_marked() -> None:
    """The fixture is all that starts one."""
    asking = [f for f in ROOT.glob("tests/**/test_*.py") if "browser: " + "Browser" in f.read_text(encoding="utf-8")]
    assert len(asking) > 30
    assert [f.name for f in asking if "browser" not in kinds_of(f)] == []


def test_a_fast_run_lets_no_test_start_a_process(tmp_path: Path) -> None:
    """Told by the interpreter itself, whatever library starts it."""
    script = (
        "import sys; from tests.conftest import _refuse_process; sys.addaudithook(_refuse_process)\n"
        "import subprocess; subprocess.run(['true'])"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "a fast test starts a process" in done.stderr
