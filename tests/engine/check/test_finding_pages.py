"""Every kind of finding has a page, and the examples of every page are what they claim to be."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import pytest

from engine.check import CODES, Finding
from engine.cli.commands.check import findings_of
from engine.registry import load_states

PAGES = Path(__file__).resolve().parents[3] / "docs" / "findings"
CATALOGUE = load_states()
TOO_LONG = {"combinations-not-checked", "beyond-driver", "outdated-state"}
"""Pages whose bad example is only sketched; `test_check.py`, `test_driver_checks.py` and `test_state_reloading.py` make
the findings."""


@dataclass(frozen=True)
class Page:
    """One page: its text, and its examples by the title above them."""

    text: str
    examples: dict[str, str]


def page(code: str) -> Page:
    """Read the page of a finding."""
    text = (PAGES / f"{code}.md").read_text(encoding="utf-8")
    found = re.findall(r"^## ([^\n]+)\n\n```yaml\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return Page(text, {title.strip("`"): example for title, example in found})


def found_in(folder: Path, of: Page, title: str) -> tuple[Finding, ...]:
    """Check an example of a page beside the other files of that page."""
    for name, content in of.examples.items():
        if "." in name:
            (folder / name).write_text(content, encoding="utf-8")
    file = folder / "behavior.yaml"
    file.write_text(of.examples[title], encoding="utf-8")
    return findings_of(file, CATALOGUE)


def test_every_finding_has_a_page_and_every_page_a_finding() -> None:
    """Nothing is missing and nothing is left over."""
    assert {file.stem for file in PAGES.glob("*.md")} == set(CODES)


@pytest.mark.parametrize("code", CODES)
def test_a_page_says_what_it_is_about(code: str) -> None:
    """Code, severity and meaning are those of the code, and all parts are there."""
    severity, meaning = CODES[code]
    text = page(code).text
    assert text.startswith(f"# `{code}`\n\n**{severity}** · {meaning}\n\n")
    titles = re.findall(r"^## (.+)$", text, re.MULTILINE)
    assert titles[:4] == ["Why it matters", "What to do", "Bad", "Good"]


@pytest.mark.parametrize("code", sorted(set(CODES) - TOO_LONG))
def test_the_bad_example_has_the_finding(tmp_path: Path, code: str) -> None:
    """It has no other error, so that what the page shows is what a reader sees."""
    findings = found_in(tmp_path, page(code), "Bad")
    assert code in {finding.code for finding in findings}, findings
    assert {finding.code for finding in findings if finding.severity == "error"} <= {code}, findings


@pytest.mark.parametrize("code", CODES)
def test_the_good_example_has_no_finding(tmp_path: Path, code: str) -> None:
    """Neither this one nor any other."""
    assert found_in(tmp_path, page(code), "Good") == ()
