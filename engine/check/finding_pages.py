"""Pages about the kinds of findings: `docs/findings/<code>.md`, or next to this file in an installed package."""

from __future__ import annotations

from pathlib import Path

from engine.check.finding import CODES
from engine.errors import FlexcellError
from engine.wording.suggestions import did_you_mean

FOLDER = "docs/findings"
"""Where the pages are in the repository."""
_HERE = Path(__file__).resolve()
_PLACES = (_HERE.parent / "pages", _HERE.parents[2] / FOLDER)


def page_name(code: str) -> str:
    """Return the page of a kind of finding, relative to the repository."""
    return f"{FOLDER}/{code}.md"


def page_text(code: str) -> str:
    """Return the page of a kind of finding, as Markdown.

    Raises:
        FlexcellError: there is no such kind of finding, or its page is not installed.
    """
    if code not in CODES:
        raise FlexcellError(f"there is no kind of finding `{code}`", hint=did_you_mean(code, CODES))
    for place in _PLACES:
        file = place / f"{code}.md"
        if file.is_file():
            return file.read_text(encoding="utf-8")
    raise FlexcellError(f"the page of `{code}` is not installed", hint=f"it is {page_name(code)} in the repository")
