"""A test is run once more only where its browser has died, and nowhere else."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from tests.tiers import ROOT

# Each test fails at its first try, and only then.
TESTS = """
import pytest

tried = set()


@pytest.fixture
def browser():
    pass


def fail_once(words):
    if words not in tried:
        tried.add(words)
        raise RuntimeError(words)


@pytest.mark.parametrize("words", [
    "Page.goto: Target crashed",
    "Locator.click: Target page, context or browser has been closed",
    "Locator expected to be visible",
    "Timeout 20000ms exceeded",
    "Page.goto: net::ERR_CONNECTION_REFUSED",
])
def test_with_a_browser(browser, words):
    fail_once(words)


def test_after_another_failure(browser):
    try:
        fail_once("Page crashed")
    except RuntimeError as error:
        raise AssertionError("the heading is not there") from error


@pytest.mark.parametrize("where", ["process"])
def test_without_a_browser(where):
    fail_once("Target crashed")


def test_that_always_dies(browser):
    raise RuntimeError("Target crashed")
"""


def test_only_a_browser_that_has_died_is_a_reason(tmp_path: Path) -> None:
    """Whatever else went wrong is told, and so is a browser that dies twice."""
    file = tmp_path / "test_first_tries.py"
    file.write_text(TESTS, encoding="utf-8")
    options = ["-p", "tests.conftest", "-p", "no:randomly", "-p", "no:cacheprovider", "--rootdir", str(tmp_path), "-v"]
    command = [sys.executable, "-m", "pytest", "-c", str(ROOT / "pyproject.toml"), *options, str(file)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    told = re.findall(r"::test_(.+?) (PASSED|FAILED|RERUN)", done.stdout)
    assert told == [
        ("with_a_browser[Page.goto: Target crashed]", "RERUN"),
        ("with_a_browser[Page.goto: Target crashed]", "PASSED"),
        ("with_a_browser[Locator.click: Target page, context or browser has been closed]", "RERUN"),
        ("with_a_browser[Locator.click: Target page, context or browser has been closed]", "PASSED"),
        ("with_a_browser[Locator expected to be visible]", "FAILED"),
        ("with_a_browser[Timeout 20000ms exceeded]", "FAILED"),
        ("with_a_browser[Page.goto: net::ERR_CONNECTION_REFUSED]", "FAILED"),
        ("after_another_failure", "RERUN"),
        ("after_another_failure", "PASSED"),
        ("without_a_browser[process]", "FAILED"),
        ("that_always_dies", "RERUN"),
        ("that_always_dies", "FAILED"),
    ]
