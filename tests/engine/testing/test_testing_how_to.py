"""The Python examples of docs/how-to/test-a-behavior.md do what the page says."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.registry import load_states
from engine.skills.gripper import ReadGripper
from engine.testing import run_behavior

PROJECT = Path(__file__).parents[3]
PAGE = (PROJECT / "docs" / "how-to" / "test-a-behavior.md").read_text(encoding="utf-8")


def _examples() -> tuple[dict[str, Any], ...]:
    """The names that each example defines."""
    found: list[dict[str, Any]] = []
    for text in re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL):
        names: dict[str, Any] = {}
        exec(compile(text, "test-a-behavior.md", "exec"), names)
        found.append(names)
    return tuple(found)


def test_the_test_of_the_transfer_passes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(PROJECT)
    test = _examples()[0]["test_the_transfer_succeeds"]
    test(partial(run_behavior, catalogue=load_states(), store=tmp_path / "store.db"))


def test_a_stand_in_ends_the_transfer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(PROJECT)
    test = _examples()[2]["test_a_part_that_is_missed_ends_the_transfer"]
    test(partial(run_behavior, catalogue=load_states(), store=tmp_path / "store.db"))


@pytest.mark.virtual
async def test_the_fake_answers() -> None:
    async with SkillBus(new_clock()) as bus:
        _examples()[1]["prepare"](bus)
        assert (await bus.call(ReadGripper(), to="left/gripper")).held
