"""Every behavior shown in the documentation passes the check and can be planned."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from engine.check import check_behavior
from engine.document import parse_behavior
from engine.registry import load_states
from engine.runtime.plan import new_plan

ROOT = Path(__file__).parents[2]
PAGES = [
    ROOT / "README.md",
    *sorted((ROOT / "docs/concepts").glob("*.md")),
    *sorted((ROOT / "docs/how-to").glob("*.md")),
]
SHOWN = [
    pytest.param(page, text, id=f"{page.relative_to(ROOT)}-{number}")
    for page in PAGES
    for number, text in enumerate(re.findall(r"(?ms)^```yaml\n(.*?)^```", page.read_text(encoding="utf-8")), 1)
    if text.startswith("flexcell: 1") and "\nroot:" in text
]


@pytest.mark.parametrize(("page", "text"), SHOWN)
def test_a_behavior_in_the_documentation_is_sound(page: Path, text: str) -> None:
    behavior = parse_behavior(text, file=ROOT / "behaviors" / "reconcycle" / page.name)  # as if it lay there
    catalogue = load_states()
    new_plan(behavior, catalogue)
    errors = [str(each) for each in check_behavior(behavior, catalogue) if each.severity == "error"]
    assert errors == []
