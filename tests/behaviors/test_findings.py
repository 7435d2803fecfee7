"""What comes with the project is free of findings: behaviors, cells and entries."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cli.commands.check import findings_of
from engine.registry import load_states

BEHAVIORS = Path(__file__).resolve().parents[2] / "behaviors"
CATALOGUE = load_states()


@pytest.mark.parametrize(
    "file", sorted(BEHAVIORS.rglob("*.yaml")), ids=lambda file: file.relative_to(BEHAVIORS).as_posix()
)
def test_a_shipped_document_has_no_findings(file: Path) -> None:
    """Each by itself, behaviors in the cells that they name."""
    assert findings_of(file, CATALOGUE) == ()
