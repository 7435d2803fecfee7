"""Reports of one sweep: they say the same, and hold against hostile text."""

from __future__ import annotations

import csv
import io
import json
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from engine.errors import FlexcellError
from engine.sweep import SweepSubject, SweepSummary, TrialResult, Trials, configurations, summarize
from engine.sweep.report import SUFFIXES, report
from engine.sweep.sweep_execution import SweepEnd
from engine.sweep.verdict.success_count import SuccessCount
from tests.engine.sweep.luck_project import LuckProject

HOSTILE = "<script>alert('x')</script> | a\nb"


def _summary(folder: Path, *, runs: int = 12, otherwise: str = "raise", **keys: object) -> SweepSummary:
    project = LuckProject(folder)
    sweep = project.sweep(runs=runs, parameters={"otherwise": otherwise}, description=HOSTILE, **keys)
    subject, trials = SweepSubject.load(sweep), None
    planned = configurations(sweep)
    count = SuccessCount(sweep.document, len(planned))
    results: list[TrialResult] = []
    for configuration in planned:
        trials = trials or Trials(subject)
        results.append(trials.run(configuration))
        count.add(results[-1])
    return summarize(SweepEnd(subject=subject, configurations=planned, results=results, count=count, ended_by="runs"))


@pytest.fixture(scope="module")
def summary(tmp_path_factory: pytest.TempPathFactory) -> SweepSummary:
    return _summary(tmp_path_factory.mktemp("report"), require="success >= 0.98")


def test_markdown_has_the_rate_the_verdict_and_the_causes(summary: SweepSummary) -> None:
    text = report(summary, None, Path("s.md")).decode()
    assert "**success >= 0.98: failed**" in text
    assert f"{summary.successes} of 12 runs succeeded" in text
    assert f"| {12 - summary.successes} " in text
    assert "the luck was" in text
    assert "| parameters.luck |" in text


def test_failures_with_other_numbers_have_one_cause(summary: SweepSummary) -> None:
    (group,) = summary.causes
    assert group.runs == 12 - summary.successes
    assert group.at == "cup"
    assert set(group.examples) <= {each.configuration.number for each in summary.failing}


def test_the_page_is_well_formed_and_loads_nothing(summary: SweepSummary) -> None:
    text = report(summary, None, Path("s.html")).decode()
    root = ET.fromstring(
        text.replace("<!doctype html>\n", "")
        .replace('<meta charset="utf-8">', "")
        .replace('<meta name="viewport" content="width=device-width, initial-scale=1">', "")
    )
    assert len(list(root.iter("svg"))) == 3
    assert all(figure.get("aria-label") for figure in root.iter("svg"))
    assert not [word for word in ("src=", "href=", "url(", "@import") if word in text]
    assert "<script" not in text
    assert "&lt;script&gt;" in text


def test_json_and_csv_have_a_row_for_each_run(summary: SweepSummary) -> None:
    document = json.loads(report(summary, None, Path("s.json")))
    assert (document["successes"], document["done"], document["verdict"]) == (summary.successes, 12, "failed")
    assert document["interval"][0] < document["rate"] < document["interval"][1]
    rows = list(csv.DictReader(io.StringIO(report(summary, None, Path("s.csv")).decode())))
    assert [row["number"] for row in rows] == [str(row["number"]) for row in document["results"]]
    assert [float(row["parameters.luck"]) for row in rows] == [row["parameters.luck"] for row in document["results"]]
    assert sum(row["success"] == "True" for row in rows) == summary.successes


def test_measures_of_successes_and_of_failures_are_apart(summary: SweepSummary) -> None:
    (duration,) = summary.measures
    assert duration.name == "run.duration_s"
    assert duration.successes is not None
    assert duration.failures is not None
    assert duration.successes.most < duration.failures.least
    assert duration.successes.runs == summary.successes
    text = report(summary, None, Path("s.md")).decode()
    assert "| run.duration_s | succeeded |" in text
    assert "| run.duration_s | failed    |" in text
    page = report(summary, None, Path("s.html")).decode()
    assert f"Runs by run.duration_s, from {duration.least:.4g} to {duration.most:.4g}" in page
    rows = json.loads(report(summary, None, Path("s.json")))["results"]
    assert [row["measures.run.duration_s"] for row in rows] == [row["duration_s"] for row in rows]


def test_covered_inputs_are_there(summary: SweepSummary) -> None:
    (luck,) = summary.inputs.factors
    assert (luck.address, luck.parts) == ("parameters.luck", 10)
    assert 3 < luck.covered <= 10
    assert summary.inputs.pairs == []
    assert f"| parameters.luck | {luck.covered} of 10 " in report(summary, None, Path("s.md")).decode()


def test_times_coverage_and_the_factor_are_there(summary: SweepSummary) -> None:
    assert {each.name for each in summary.nodes} == {"root", "root/only"}
    assert summary.duration_s is not None
    assert 1.0 < summary.duration_s.least < summary.duration_s.most < 1.5
    assert [item.name for item in summary.missing] == ["missed", "missed"]
    (effect,) = summary.effects
    assert effect.spread == 1.0


def test_every_report_tells_each_requirement(tmp_path: Path) -> None:
    limit = "share(run.duration_s <= 1.6) >= 0.1"
    found = _summary(tmp_path, require=[limit, "share(force_n <= 1) >= 0.5"])
    kept = sum(each.duration_s <= 1.6 for each in found.results)
    assert 0 < kept < 12
    text = report(found, None, Path("s.md")).decode()
    assert f"**{limit}: passed; share(force_n <= 1) >= 0.5: failed**" in text
    assert f"| {limit} | passed  | {kept} of 12 " in text
    page = report(found, None, Path("s.html")).decode()
    assert "<td>share(force_n &lt;= 1) &gt;= 0.5</td><td>failed</td><td>0 of 12</td>" in page
    told = json.loads(report(found, None, Path("s.json")))
    assert [(each["text"], each["kept"], each["missing"]) for each in told["requirements"]] == [
        (limit, kept, 0),
        ("share(force_n <= 1) >= 0.5", 0, 12),
    ]
    assert told["verdict"] == "failed"


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("keys", [{"runs": 1}, {"runs": 3, "design": "grid"}, {"runs": 2, "factors": {}}])
def test_small_sweeps_have_every_report(tmp_path: Path, suffix: str, keys: dict[str, object]) -> None:
    assert report(_summary(tmp_path, **keys), None, Path(f"s{suffix}"))  # pyright: ignore[reportArgumentType]


def test_another_suffix_is_refused(summary: SweepSummary) -> None:
    with pytest.raises(FlexcellError, match=r"s.pdf: there is no report `.pdf` \(.md, .html, .json, .csv, .parquet\)"):
        report(summary, None, Path("s.pdf"))
