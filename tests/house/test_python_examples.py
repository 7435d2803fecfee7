"""The Python examples of docs/how-to/use-from-python.md do what the page says, one after the other."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import pytest

from engine import CompletedRun
from engine.replay import ReplayReport

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "how-to" / "use-from-python.md").read_text(encoding="utf-8")
MODULE, *EXAMPLES = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)
(PROJECT_FILE,) = re.findall(r"^```\n(flexcell: 1\n.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)


@pytest.fixture
def weighing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A project folder with the module and the project file of the page."""
    (tmp_path / "weighing.py").write_text(MODULE, encoding="utf-8")
    (tmp_path / "flexcell.yaml").write_text(PROJECT_FILE, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    monkeypatch.delitem(sys.modules, "weighing", raising=False)


def _executed(example: str, names: dict[str, Any]) -> None:
    exec(compile(example, str(Path("page.py").resolve()), "exec"), names)


@pytest.mark.usefixtures("weighing")
def test_a_project_is_checked_run_recorded_and_replayed(capsys: pytest.CaptureFixture[str]) -> None:
    names: dict[str, Any] = {}
    for example in EXAMPLES[:3]:
        _executed(example, names)
    assert capsys.readouterr().out.splitlines()[:2] == ["0.4", f"kept 0.4 {len(names['done'].events)}"]
    again: ReplayReport = names["again"]
    assert (again.same, again.recording.description.parameters) == (True, {"limit_kg": 0.3})
    assert Path("heavy.mcap").is_file()


@pytest.mark.usefixtures("weighing")
async def test_a_run_in_a_notebook_has_a_loop_of_its_own() -> None:
    """There the loop of the notebook runs while a cell of it is executed."""
    names: dict[str, Any] = {}
    _executed(EXAMPLES[1], names)
    _executed(EXAMPLES[2], names)
    done: CompletedRun = names["done"]
    assert (done.outcome, done.result.userdata) == ("kept", {"part_kg": 0.4})


@pytest.mark.usefixtures("weighing")
def test_a_mistake_in_a_state_is_found_before_the_run() -> None:
    names: dict[str, Any] = {}
    _executed(EXAMPLES[1].replace('"heavy": "refused"', '"heavy": "nowhere"').partition("done =")[0], names)
    assert [finding.severity for finding in names["project"].check(names["sorting"])].count("error") == 1


def test_the_transfer_has_no_mistake(monkeypatch: pytest.MonkeyPatch) -> None:
    """It runs in its cell in `tests/behaviors/test_shown_behaviors.py`."""
    monkeypatch.chdir(ROOT)
    names: dict[str, Any] = {}
    _executed(EXAMPLES[3].partition("done =")[0], names)
    assert [finding for finding in names["project"].check(names["transfer"]) if finding.severity == "error"] == []
