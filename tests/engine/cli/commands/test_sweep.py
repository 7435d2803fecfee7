"""`flexcell sweep` as a user runs it."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from tests.engine.cli.command import CommandOutput, flexcell
from tests.engine.sweep.luck_project import LuckProject
from tests.engine.test_pytest_plugin import run_pytest


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> LuckProject:
    return LuckProject(tmp_path_factory.mktemp("sweeps"))


ONE = ("--workers", "1")
"""A process more costs a second; what several do at a time is tested in `tests/engine/sweep`."""


def _sweep(project: LuckProject, *arguments: str | Path) -> CommandOutput:
    return flexcell("sweep", *arguments, cwd=project.path)


def test_a_behavior_is_swept_from_options_alone(project: LuckProject) -> None:
    ended = _sweep(project, "luck.yaml", "--vary", "luck=0.0..1.0", "--runs", "6", "--results", "a.db")
    assert ended.code == 0, ended.err
    assert "# Sweep of luck.yaml" in ended.out
    assert "of 6 runs succeeded" in ended.out
    assert "6 of 6: " in ended.err
    assert "runs/min" in ended.err


def test_a_document_with_options_is_swept_in_parts_and_reported(project: LuckProject) -> None:
    file = project.write(runs=6, seed=5)
    parts = ["p1.db", "p2.db"]
    for number, part in enumerate(parts, start=1):
        ended = _sweep(project, file, "--shard", f"{number}/2", "--results", part, "--quiet", *ONE)
        assert (ended.code, ended.err) == (0, "")
    assert "6 results added to all.db" in _sweep(project, "merge", *parts, "--to", "all.db").err
    told = _sweep(
        project, "report", file, "--results", "all.db", "--json", "--require", "success >= 0.999",
        "--require", "share(duration_s <= 2) >= 0.4", "--junit", "j.xml", "--report", "r.html", "--report", "r.csv",
    )  # fmt: skip
    document = json.loads(told.out)
    assert (document["done"], document["verdict"]) == (6, "failed")
    assert told.code == 1
    success, duration = ET.parse(project.path / "j.xml").iter("testcase")
    assert (success.get("name"), duration.get("name")) == ("success >= 0.999", "share(duration_s <= 2) >= 0.4")
    assert success.find("failure") is not None
    assert duration.find("failure") is None
    assert (project.path / "r.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    assert len((project.path / "r.csv").read_text(encoding="utf-8").splitlines()) == 7


def test_what_is_required_decides_the_exit_code(project: LuckProject) -> None:
    def code(rate: str, required: str, runs: str) -> int:
        return _sweep(
            project, "luck.yaml", "--vary", "luck=0.0..1.0", "-p", f"rate={rate}", "--require", required,
            "--runs", runs, "--results", "codes.db", "--quiet", *ONE,
        ).code  # fmt: skip

    assert code("1.0", "success >= 0.5", "40") == 0
    assert code("0.0", "success >= 0.5", "40") == 1
    assert code("1.0", "success >= 0.99", "5") == 5


def test_a_failure_is_repeated_shrunk_and_kept_as_a_case(project: LuckProject) -> None:
    options = ("--vary", "luck=0.0..1.0", "--vary", "rate=0.3..0.6", "--runs", "8", "--results", "f.db")
    rows = json.loads(_sweep(project, "luck.yaml", *options, *ONE, "--json").out)["results"]
    failing = next(str(row["number"]) for row in rows if not row["success"])
    again = _sweep(project, "rerun", "luck.yaml", failing, *options, "--record", "again.mcap")
    assert again.code == 0, again.out
    assert "the same events as before" in again.out
    assert flexcell("replay", "again.mcap", cwd=project.path).code == 0
    small = _sweep(project, "shrink", "luck.yaml", failing, *options, "--case", "cases/unlucky.yaml")
    assert small.code == 0, small.err
    assert "parameters.luck" in small.out
    assert _sweep(project, "cases/unlucky.yaml", "--results", "c.db", *ONE).code == 1
    # The behavior is mended: the case passes.
    mended = _sweep(project, "cases/unlucky.yaml", "--vary", "rate=1.0,1.0", "--results", "c.db", "--json", *ONE)
    assert mended.code == 0, mended.out


def test_a_search_finds_failures_and_one_is_shrunk_to_a_case_that_pytest_executes(project: LuckProject) -> None:
    options = ("--vary", "luck=0.0..1.0", "--vary", "rate=0.7..0.8", "--results", "s.db")
    searched = ("--search", "most duration_s", "--runs", "30", "--stop-after", "3")
    found = _sweep(project, "luck.yaml", *options, *searched, "--report", "s.html")
    assert found.code == 1, found.err
    assert "The search ended with 3 failures" in found.out
    assert "batch 0, " in found.err
    assert (project.path / "s.html").read_text(encoding="utf-8").count("<svg") == 2
    failing = found.out.partition("the first one is run #")[2].partition(".")[0]
    small = _sweep(
        project, "shrink", "luck.yaml", failing, *options, *searched[:4], "--case", "cases/lucky.yaml",
        "--record", "lucky.mcap",
    )  # fmt: skip
    assert small.code == 0, small.err
    assert "without placement noise" in small.out
    assert "still varied: parameters.luck" in small.err
    assert (project.path / "lucky.mcap").stat().st_size > 0
    tested = run_pytest(project.path, "--flexcell-sweeps", "cases", "-m", "flexcell_sweep")
    assert tested.code == 1, tested.out
    assert "success >= 1: failed after 1 runs" in tested.out
    assert "ended with missed" in tested.out


def test_a_changed_behavior_is_compared_with_its_baseline(tmp_path: Path) -> None:
    project = LuckProject(tmp_path)
    options = ("--vary", "luck=0.0..1.0", "--runs", "40", "--quiet", *ONE)
    assert _sweep(project, "luck.yaml", *options, "--results", "old.db").code == 0
    text = project.behavior.read_text(encoding="utf-8")
    project.behavior.write_text(text.replace("default: 0.5", "default: 0.05"), encoding="utf-8")
    ended = _sweep(project, "luck.yaml", *options, "--results", "new.db", "--baseline", "old.db", "--margin", "0.01")
    assert ended.code == 1
    assert "worse than the baseline" in ended.out
    assert "Changed: behavior." in ended.out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["luck.yaml", "--vary", "lucky=0..1"], "the behavior has no parameter `lucky` (did you mean luck?)"),
        (["luck.yaml", "--vary", "displace.bolt.x_m=0..1"], "`displace.bolt.x_m` needs a cell"),
        (["luck.yaml", "--vary", "luck"], "'luck' is not a factor"),
        (["luck.yaml", "-p", "rat=1"], "there is no parameter `rat` (did you mean rate?)"),
        (["luck.yaml", "--shard", "3/2"], "'3/2' is not a part of a sweep"),
        (["luck.yaml", "--margin", "0.1", "--runs", "1"], "--margin requires --baseline"),
        (["luck.yaml", "--scheduler", "tcp://127.0.0.1:1", "--workers", "2"], "--workers is of this machine"),
        (["luck.yaml", "--tls-cert", "me.pem"], "give --scheduler too"),
        (["luck.yaml", "--scheduler", "tls://127.0.0.1:1", "--tls-cert", "me.pem"], "there is no such file"),
        (["luck.yaml", "--vary", "luck=0..1", "--search", "failure", "--shard", "1/2"], "a search has no parts"),
        (["luck.yaml", "--vary", "luck=0..1", "--search", "failure", "--baseline", "b.db"], "cannot be compared"),
        (["luck.yaml", "--search", "failure"], "a search has nothing to vary"),
        (["luck.yaml", "--vary", "luck=0..1", "--search", "lest duration_s"], "`towards`"),
        (["none.yaml"], "cannot read this file"),
        (["report", "luck.yaml", "--results", "none.db"], "there are no results yet"),
        (["shrink", "luck.yaml", "900"], "the sweep has no configuration 900 (0 to 99)"),
        (["merge", "none.db", "--to", "m.db"], "there is no such file"),
        (["luck.yaml", "--require", "success > 1"], "`require`"),
        (["luck.yaml", "--require", "success >= 1", "--require", "most a <= 3"], "'most a <= 3' is no requirement"),
    ],
)
def test_a_mistake_executes_nothing_and_says_what_to_do(
    project: LuckProject, arguments: list[str], message: str
) -> None:
    ended = _sweep(project, *arguments)
    assert ended.code == 2, ended.out
    assert message in ended.err
    assert "Traceback" not in ended.err


def test_a_github_job_gets_a_summary_and_an_annotation(
    project: LuckProject, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    summary = tmp_path / "summary.md"
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(summary))
    ended = _sweep(
        project, "luck.yaml", "-p", "rate=0.0", "-p", "luck=0.5", "--require", "success >= 0.9", "--results", "g.db",
        *ONE,
    )  # fmt: skip
    assert ended.code == 1
    assert "::error title=success >= 0.9: failed::0 of " in ended.err
    assert "# Sweep of luck.yaml" in summary.read_text(encoding="utf-8")
