"""The behavior of docs/how-to/move-an-arm.md runs as the page says."""

from __future__ import annotations

import re
from pathlib import Path

from engine.cause_chain import describe_cause
from engine.registry import load_states
from engine.testing.behavior_run import run_behavior

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs" / "how-to" / "move-an-arm.md"


def test_the_behavior_of_the_page_finds_the_table_and_is_shown_a_way(tmp_path: Path) -> None:
    """Without a hand the arm floats where it is."""
    text = next(
        block
        for block in re.findall(r"^```yaml\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
        if "find_and_show" in block
    )
    file = tmp_path / "find_and_show.yaml"
    file.write_text(text.replace("..", str(ROOT / "behaviors")), encoding="utf-8")
    ran = run_behavior(file, catalogue=load_states(), store=tmp_path / "store.db")
    assert ran.outcome == "shown", describe_cause(ran.result.cause) if ran.result.cause else ran.result
