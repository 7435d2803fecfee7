"""The generated pages of the reference are those of the present code."""

from __future__ import annotations

import importlib.util
from pathlib import Path

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_the_committed_reference_is_current() -> None:
    """Run `python docs/make_reference.py` after changing a command, a state, a finding or the face of the engine."""
    spec = importlib.util.spec_from_file_location("make_reference", DOCS / "make_reference.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    stale = [
        name for name, text in module.pages().items() if (DOCS / "reference" / name).read_text(encoding="utf-8") != text
    ]
    assert stale == []
