"""Reports of coverage: a table, one HTML page, Cobertura XML, lcov, JSON."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import msgspec
import pytest

from engine.coverage import BehaviorCoverage
from engine.coverage.coverage_file import CoverageFile
from engine.coverage.line_coverage import by_file
from engine.coverage.report import report
from tests.engine.coverage.covered import covered, written

MAIN = """
root:
  machine:
    initial: one
    states:
      one: {behavior: sub.yaml, transitions: {good: two, bad: bad}}
      two:
        behavior: sub.yaml
        transitions:
          good: good
          bad: bad
      three: {state: test.Give, transitions: {a: good, b: bad, c: bad}}
"""
SUB = """
description: <b>Gives</b> & takes
root:
  machine:
    initial: give
    states:
      give: {state: test.Give, transitions: {a: good, b: bad, c: bad}}
"""


@pytest.fixture
def coverages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[BehaviorCoverage, ...]:
    """One run of a behavior that uses another twice and has a node that nothing leads to."""
    monkeypatch.chdir(tmp_path)
    return (covered(written(tmp_path, {"main.yaml": MAIN, "sub.yaml": SUB})).record(),)


def test_the_table_names_what_is_missing_with_its_place(coverages: tuple[BehaviorCoverage, ...]) -> None:
    """Of a node that was never entered it says only that."""
    assert report(coverages, "text", time_s=0.0) == (
        "test (main.yaml), 1 run\n"
        "\n"
        "node                entered    exits\n"
        "root                      1      1/2\n"
        "    main.yaml:3:18: outcome bad\n"
        "root/one                  1      1/2\n"
        "    main.yaml:10:58: bad → bad\n"
        "root/one/root             1      1/2\n"
        "    sub.yaml:3:18: outcome bad\n"
        "root/one/root/give        1      1/3\n"
        "    sub.yaml:11:55: b → bad\n"
        "    sub.yaml:11:63: c → bad\n"
        "root/two                  1      1/2\n"
        "    main.yaml:15:11: bad → bad\n"
        "root/two/root             1      1/2\n"
        "    sub.yaml:3:18: outcome bad\n"
        "root/two/root/give        1      1/3\n"
        "    sub.yaml:11:55: b → bad\n"
        "    sub.yaml:11:63: c → bad\n"
        "root/three                0      0/3\n"
        "    main.yaml:16:7: never entered\n"
        "\n"
        "51.9 % covered: 7 of 8 nodes, 3 of 6 outcomes, 4 of 13 transitions\n"
    )


def test_lcov_has_nodes_as_functions_and_ways_as_branches(coverages: tuple[BehaviorCoverage, ...]) -> None:
    """A document used twice is added up; `-` marks ways of a node that was never entered."""
    records = report(coverages, "lcov", time_s=0.0).split("end_of_record\n")
    assert records[1].splitlines() == [
        "TN:", "SF:sub.yaml", "FN:7,root/one/root", "FN:11,root/one/root/give", "FNDA:2,root/one/root",
        "FNDA:2,root/one/root/give", "FNF:2", "FNH:2", "BRDA:3,0,0,2", "BRDA:3,0,1,0", "BRDA:11,0,0,2",
        "BRDA:11,0,1,0", "BRDA:11,0,2,0", "BRF:5", "BRH:2", "DA:3,2", "DA:7,2", "DA:11,2", "LF:3", "LH:3",
    ]  # fmt: skip
    assert "BRDA:16,0,0,-" in records[0].splitlines()


def test_cobertura_adds_up(coverages: tuple[BehaviorCoverage, ...]) -> None:
    """The rates of the whole, of packages and of classes are those of their lines."""
    root = fromstring(report(coverages, "cobertura", time_s=12.0).split('coverage-04.dtd">')[1])
    lines = root.findall(".//line")
    conditions = root.findall(".//condition")
    taken = [condition for condition in conditions if condition.get("coverage") == "100%"]
    assert _numbers(root, "lines-valid", "lines-covered", "branches-valid", "branches-covered", "timestamp") == (
        len(lines), sum(line.get("hits") != "0" for line in lines), len(conditions), len(taken), 12_000,
    )  # fmt: skip
    assert [name.get("filename") for name in root.findall(".//class")] == ["main.yaml", "sub.yaml"]
    assert [line.get("condition-coverage") for line in root.findall(".//class[@name='sub.yaml']//line")] == [
        "50% (1/2)", None, "33% (1/3)",
    ]  # fmt: skip


def _numbers(element: Element, *names: str) -> tuple[int, ...]:
    return tuple(int(element.get(name, "-1")) for name in names)


class _Page(HTMLParser):
    """Collects what a page links to, and checks that its tags are closed in order."""

    def __init__(self) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.links: list[str] = []
        self.open: list[str] = []
        self.texts: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.ids += [given["id"] or ""] if "id" in given else []
        self.links += [given["href"] or ""] if "href" in given else []
        if tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


def test_the_page_is_one_file_whose_links_lead_somewhere(coverages: tuple[BehaviorCoverage, ...]) -> None:
    """Nothing is loaded from elsewhere, and the text of documents is text."""
    html = report(coverages, "html", time_s=0.0)
    page = _Page()
    page.feed(html)
    assert (page.open, len(set(page.ids)), {link.removeprefix("#") for link in page.links} <= set(page.ids)) == (
        [], len(page.ids), True,
    )  # fmt: skip
    assert not any(word in html for word in ("http://", "https://", "<script", "@import", "url(", "<b>"))
    assert "description: <b>Gives</b> & takes" in page.texts
    assert {"covered", "partly covered", "not covered"} <= set(page.texts)


def test_a_document_that_was_changed_since_is_not_shown(coverages: tuple[BehaviorCoverage, ...]) -> None:
    """Its lines would be other lines."""
    Path("sub.yaml").write_text(f"# changed\n{SUB}", encoding="utf-8")
    html = report(coverages, "html", time_s=0.0)
    assert html.count("has changed since the run") == 1
    assert "takes" not in html


def test_json_is_a_coverage_file_again(coverages: tuple[BehaviorCoverage, ...]) -> None:
    """So that reports can be added up later."""
    text = report(coverages, "json", time_s=0.0)
    assert msgspec.json.decode(text, type=CoverageFile).behaviors == coverages


def test_a_line_is_partial_when_some_of_it_was_seen(coverages: tuple[BehaviorCoverage, ...]) -> None:
    """All three kinds of lines are there."""
    main, sub = by_file(coverages)
    assert {line.number: line.status for line in main.lines} == {
        3: "partial", 6: "covered", 10: "partial", 11: "covered", 14: "covered", 15: "missed", 16: "missed",
    }  # fmt: skip
    assert (main.branches_taken, main.branches, sub.branches_taken, sub.branches) == (3, 9, 2, 5)
