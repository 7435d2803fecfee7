"""Coverage files: written in one step, added up, and never mixed between versions of a document."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.coverage import merge, read_coverage
from engine.errors import FlexcellError
from tests.engine.coverage.covered import covered, written

GIVE = """
root:
  machine:
    initial: give
    states:
      give: {state: test.Give, transitions: {a: good, b: bad, c: bad}}
"""


def test_a_file_accumulates_runs(tmp_path: Path) -> None:
    """Twice the same run: one behavior, two runs, every count doubled."""
    coverage = covered(written(tmp_path, {"main.yaml": GIVE}))
    file = tmp_path / "coverage.json"
    coverage.accumulate(file)
    coverage.accumulate(file)
    (kept,) = read_coverage(file)
    assert (kept.runs, kept.percent, [item.count for item in kept.items]) == (
        2, coverage.percent, [2 * item.count for item in coverage.items],
    )  # fmt: skip
    assert [path.name for path in tmp_path.iterdir() if path.suffix == ".part"] == []


def test_another_version_of_a_document_is_refused_before_anything_runs(tmp_path: Path) -> None:
    """A comment is no other version; a transition is."""
    file = tmp_path / "coverage.json"
    covered(written(tmp_path, {"main.yaml": GIVE})).accumulate(file)
    covered(written(tmp_path, {"main.yaml": f"# said\n{GIVE}"})).accumulate(file)
    other = covered(written(tmp_path, {"main.yaml": GIVE.replace("b: bad", "b: good")}))
    with pytest.raises(FlexcellError, match="two different versions of this document"):
        other.require_same(file)
    (kept,) = read_coverage(file)
    assert (kept.runs, kept.items[-1].line) == (2, 11)


def test_another_version_of_a_document_that_two_behaviors_use_is_refused(tmp_path: Path) -> None:
    """Also where the behaviors themselves are different files."""
    use = "root: {behavior: used.yaml}\n"
    first = covered(written(tmp_path, {"one.yaml": use, "used.yaml": GIVE})).record()
    second = covered(written(tmp_path, {"two.yaml": use, "used.yaml": GIVE.replace("b: bad", "b: good")})).record()
    with pytest.raises(FlexcellError, match=r"used\.yaml: the coverage is of two different versions"):
        merge((first, second))


@pytest.mark.parametrize("content", ["", "[]", '{"flexcell_coverage": 2}', '{"behaviors": [{}]}'])
def test_what_is_no_coverage_file_is_refused(tmp_path: Path, content: str) -> None:
    """With its name, in one line."""
    file = tmp_path / "coverage.json"
    file.write_text(content, encoding="utf-8")
    with pytest.raises(FlexcellError, match=r"coverage\.json: this is not a coverage file") as raised:
        read_coverage(file)
    assert "\n" not in str(raised.value)
