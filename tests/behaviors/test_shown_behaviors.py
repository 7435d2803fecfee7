"""Behaviors that the README, the concepts and the how-to pages show run to their success."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import numpy as np
import pytest

from engine.cause_chain import describe_cause
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document import parse_behavior
from engine.document.cell import load_cell
from engine.messages.demonstrations import Trajectory
from engine.registry import load_states
from engine.skills.entries import WriteEntry
from engine.testing.behavior_run import run_behavior
from tests.house.shown_examples import BEHAVIOR, SHOWN, shown

ROOT = Path(__file__).parents[2]
CELL = ROOT / "behaviors" / "cells" / "dual_panda.yaml"
NEEDS_A_CELL = re.compile(r"state: (?!flow\.)")
MOVING, OTHER_HOW_TO, CONCEPTS = "docs/how-to/move-", "docs/how-to/(?!move-)", "(?!docs/how-to/)"
"""Three tests, so that they are in different turns: each simulates for a while."""


@shown(holding=BEHAVIOR, on=CONCEPTS)
def test_a_behavior_of_a_concept_runs_to_its_success(tmp_path: Path, text: str) -> None:
    run_to_its_success(tmp_path, text)


@shown(holding=BEHAVIOR, on=MOVING)
def test_a_behavior_that_moves_an_arm_runs_to_its_success(tmp_path: Path, text: str) -> None:
    run_to_its_success(tmp_path, text)


@shown(holding=BEHAVIOR, on=OTHER_HOW_TO)
def test_a_behavior_of_any_other_guide_runs_to_its_success(tmp_path: Path, text: str) -> None:
    run_to_its_success(tmp_path, text)


def test_the_transfer_in_python_runs_in_its_cell(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    page = (ROOT / "docs" / "how-to" / "use-from-python.md").read_text(encoding="utf-8")
    example = re.findall(r"^```python\n(.*?)^```", page, flags=re.DOTALL | re.MULTILINE)[-1]
    monkeypatch.chdir(ROOT)
    exec(compile(example, str(Path("page.py").resolve()), "exec"), {})
    assert capsys.readouterr().out.startswith("finished ")


def test_every_behavior_that_is_shown_is_run_once() -> None:
    behaviors = [name for name, text in SHOWN.items() if BEHAVIOR in text]
    assert len(behaviors) > 10
    assert all(sum(bool(re.match(on, name)) for on in (CONCEPTS, MOVING, OTHER_HOW_TO)) == 1 for name in behaviors)


def run_to_its_success(folder: Path, text: str) -> None:
    """In the cell it names, else that of the two Pandas, if it needs one; what it was shown by hand is in the store."""
    file, store = folder / "example.yaml", folder / "store.db"
    file.write_text(text.replace("../cells", str(CELL.parent)), encoding="utf-8")
    cell = None if "\ncell:" in text or not NEEDS_A_CELL.search(text) else CELL
    if "recording: led" in text:
        run_virtual(lead_by_hand(store))
    ran = run_behavior(file, catalogue=load_states(), store=store, cell=cell)
    success = parse_behavior(text, file=file).success
    assert ran.outcome in success, describe_cause(ran.result.cause) if ran.result.cause else ran.result


async def lead_by_hand(store: Path) -> None:
    """Keep the recording of a hand that turns the left arm by a quarter of a radian in two seconds."""
    times = np.linspace(0.0, 2.0, 101)
    joints = np.tile((0.0, -0.785398163, 0.0, -2.35619449, 0.0, 1.570796327, 0.785398163), (101, 1))
    joints[:, 0] = 0.25 * np.sin(np.pi * np.clip(times - 0.2, 0.0, 1.6) / 3.2) ** 2
    led = Trajectory(times_s=tuple(times.tolist()), joints=tuple(tuple(row) for row in joints.tolist()))
    async with OpenCell(load_cell(CELL), store_path=str(store)) as cell:
        await cell.bus.call(WriteEntry(kind="trajectory", name="led", value=msgspec.to_builtins(led)), to="store")
