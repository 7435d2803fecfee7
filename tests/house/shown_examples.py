"""The YAML examples of the README, the concepts and the how-to pages, each with the page it stands on."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *(ROOT / "docs/concepts").glob("*.md"), *(ROOT / "docs/how-to").glob("*.md")]
BEHAVIOR = "\nroot:"
SHOWN = {
    f"{page.relative_to(ROOT)}-{number}": text
    for page in sorted(PAGES)
    for number, text in enumerate(re.findall(r"(?ms)^```yaml\n(.*?)^```", page.read_text(encoding="utf-8")), 1)
}


def shown(*beginnings: str, holding: str = "", on: str = "") -> pytest.MarkDecorator:
    """The examples that begin so, or hold this, on pages whose path matches `on`."""
    chosen = [
        pytest.param(text, id=name)
        for name, text in SHOWN.items()
        if ((beginnings and text.startswith(beginnings)) or (holding and holding in text)) and re.match(on, name)
    ]
    return pytest.mark.parametrize("text", chosen)
