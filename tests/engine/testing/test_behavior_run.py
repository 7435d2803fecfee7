"""Running behaviors from tests: with fakes, faults and watchers, and refused when they have errors."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.errors import DocumentError
from engine.event import Event, FaultInjected
from engine.testing import run_behavior
from tests.engine.replay.rig import CATALOGUE, Rig
from tests.engine.run_document import HEAD

LOOK = """
root:
  machine:
    initial: look
    states:
      look: {state: bench.Look, on_error: bad, transitions: {a: good, b: good, c: bad}}
"""


@pytest.fixture
def behavior(tmp_path: Path) -> Path:
    """A behavior that looks through the camera of the bench."""
    file = tmp_path / "look.yaml"
    file.write_text(HEAD + LOOK, encoding="utf-8")
    return file


def test_fakes_of_the_test_answer(behavior: Path, tmp_path: Path) -> None:
    seen: list[Event] = []
    ran = run_behavior(behavior, catalogue=CATALOGUE, store=tmp_path / "s.db", prepare=Rig, watchers=[seen.append])
    assert ran.outcome == "good"
    assert list(ran.events) == seen


def test_without_them_nobody_answers(behavior: Path, tmp_path: Path) -> None:
    assert run_behavior(behavior, catalogue=CATALOGUE, store=tmp_path / "s.db").outcome == "bad"


def test_faults_are_injected(behavior: Path, tmp_path: Path) -> None:
    (tmp_path / "faults.yaml").write_text("flexcell: 1\nfaults: [{at: '**', error: dark}]\n", encoding="utf-8")
    faults = tmp_path / "faults.yaml"
    ran = run_behavior(behavior, catalogue=CATALOGUE, store=tmp_path / "s.db", prepare=Rig, faults=faults)
    assert ran.outcome == "bad"
    assert any(isinstance(event, FaultInjected) for event in ran.events)


def test_a_behavior_with_errors_is_refused_with_its_place(behavior: Path, tmp_path: Path) -> None:
    behavior.write_text(HEAD + LOOK.replace("a: good", "a: nowhere"), encoding="utf-8")
    with pytest.raises(DocumentError, match=r"look\.yaml:\d+:\d+: .*nowhere"):
        run_behavior(behavior, catalogue=CATALOGUE, store=tmp_path / "s.db", prepare=Rig)
