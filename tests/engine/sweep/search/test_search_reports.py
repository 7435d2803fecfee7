"""Reports of a search: failures, where they are, and no success rate."""

from __future__ import annotations

import csv
import io
import json
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from engine.errors import FlexcellError
from engine.sweep import SweepSubject
from engine.sweep.search import SearchEnd, SearchSummary, search_report, summarize_search
from engine.sweep.search.search_plan import SearchPlan
from tests.engine.sweep.luck_project import LuckProject
from tests.engine.sweep.search.luck_search import luck_result, luck_search


def _summary(folder: Path, **search: str | int) -> SearchSummary:
    subject = SweepSubject.load(luck_search(LuckProject(folder), time=None, **search))
    plan = SearchPlan(subject.sweep)
    while batch := plan.due():
        plan.take([luck_result(point.configuration) for point in batch])
    ended_by = "failures" if plan.is_satisfied else "runs"
    return summarize_search(
        SearchEnd(subject=subject, spec=plan.spec, target=plan.target, steps=plan.steps, ended_by=ended_by)
    )


@pytest.fixture(scope="module")
def summary(tmp_path_factory: pytest.TempPathFactory) -> SearchSummary:
    return _summary(tmp_path_factory.mktemp("report"))


def test_failures_are_grouped_by_cause_with_the_factor_that_tells_most_first(tmp_path: Path) -> None:
    found = _summary(tmp_path, runs=120)
    assert {cluster.cause.at for cluster in found.clusters} == {"cup", "root.only"}
    for cluster in found.clusters:
        first, second = cluster.regions
        assert (first.address, first.listed) == ("parameters.luck", False)
        low, high = (float(str(value)) for value in first.failing)
        assert 0.9 <= low <= high <= 1.0
        assert (first.share, first.passed_inside) == (pytest.approx(high - low), 0)
        assert second.failing == (["raise"] if cluster.cause.at == "cup" else ["miss"])
        assert second.share == 0.5
    assert sum(cluster.cause.runs for cluster in found.clusters) == len(found.failing)


def test_few_failures_of_a_cause_have_no_region(tmp_path: Path) -> None:
    found = _summary(tmp_path, stop_after=2)
    assert [cluster.regions for cluster in found.clusters] == [[]] * len(found.clusters)
    text = search_report(found, Path("s.md")).decode()
    assert "Causes of one or two runs" in text
    assert "likelihood of that" not in text


def test_the_batches_come_nearer_to_failure(summary: SearchSummary) -> None:
    assert [batch.runs for batch in summary.batches] == [10] * 6
    failures = [batch.failures for batch in summary.batches]
    assert failures[0] < 3 < max(failures)
    nearest = summary.target.value(summary.nearest[0])
    assert nearest is not None
    assert 1.8 < nearest < 1.9
    assert max(batch.nearest or 0.0 for batch in summary.batches) == nearest


def test_no_report_has_a_success_rate_and_all_say_why(summary: SearchSummary) -> None:
    text = search_report(summary, Path("s.md")).decode()
    assert f"{len(summary.failing)} of 60 runs failed" in text
    assert "their share of failures is no rate" in text
    assert "effective failures" in text
    assert "succeeded" not in text
    assert f"flexcell sweep shrink FILE {summary.failing[0].configuration.number}" in text
    assert summary.probability is not None
    assert summary.probability.interval.low < 0.1 < summary.probability.interval.high


def test_optuna_says_that_it_has_no_estimate(tmp_path: Path) -> None:
    found = _summary(tmp_path, method="optuna", runs=20)
    assert found.probability is None
    assert "no success rate and no interval of it" in search_report(found, Path("s.md")).decode()


def test_a_search_that_finds_nothing_says_so_and_how_likely_failures_may_be(tmp_path: Path) -> None:
    found = _summary(tmp_path, runs=4, batch=4)
    text = search_report(found, Path("s.md")).decode()
    assert "No failure in 4 runs" in text
    assert "0.0 % of all runs fail; 0.0 % to" in text
    assert "shrink" not in text


def test_a_search_that_ends_with_its_failures_says_so(tmp_path: Path) -> None:
    found = _summary(tmp_path, stop_after=1)
    assert "The search ended with 1 failures" not in search_report(found, Path("s.md")).decode()
    assert "The search ended with its first failure" in search_report(found, Path("s.md")).decode()


def test_the_page_is_well_formed_and_loads_nothing(summary: SearchSummary) -> None:
    text = search_report(summary, Path("s.html")).decode()
    root = ET.fromstring(
        text.replace("<!doctype html>\n", "")
        .replace('<meta charset="utf-8">', "")
        .replace('<meta name="viewport" content="width=device-width, initial-scale=1">', "")
    )
    (trace,) = root.iter("svg")
    crosses = [each for each in trace.iter("path") if each.get("class") == "bad"]
    dots = [each for each in trace.iter("circle") if each.get("class") == "good"]
    assert (len(crosses), len(dots)) == (len(summary.failing), 60 - len(summary.failing))
    assert not [word for word in ("src=", "href=", "url(", "@import", "<script") if word in text]


def test_json_and_csv_have_a_row_for_each_run(summary: SearchSummary) -> None:
    document = json.loads(search_report(summary, Path("s.json")))
    assert (document["done"], document["failures"]) == (60, len(summary.failing))
    assert "rate" not in document
    assert [row["batch"] for row in document["results"]] == sorted([0, 1, 2, 3, 4, 5] * 10)
    assert all(0.0 < row["weight"] <= 5.0 for row in document["results"])
    rows = list(csv.DictReader(io.StringIO(search_report(summary, Path("s.csv")).decode())))
    assert len(rows) == 60


def test_there_is_no_other_report(summary: SearchSummary) -> None:
    with pytest.raises(FlexcellError, match="there is no report"):
        search_report(summary, Path("s.pdf"))
