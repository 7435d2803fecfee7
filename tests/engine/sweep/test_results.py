"""Results in a file."""

from __future__ import annotations

import sqlite3
import time
from pathlib import Path

import msgspec
import pytest

from engine.errors import FlexcellError
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_result import NodeTime, TrialResult
from engine.sweep.results import SweepResults, without_costs


def _result(number: int, *, outcome: str = "done", wall_s: float = 1.0) -> TrialResult:
    return TrialResult(
        configuration=Configuration(number=number, seed=number, values={"parameters.luck": 0.1 * number}),
        status="finished",
        outcome=outcome,
        success=outcome == "done",
        nodes={"root/only": NodeTime(visits=1, total_s=1.5)},
        outputs={"force_n": 3.25},
        covered="f3",
        wall_s=wall_s,
        cpu_s=wall_s,
        memory_bytes=10,
    )


def _file(path: Path, *results: TrialResult, subject: str = "a") -> Path:
    with SweepResults.open(path) as saved:
        saved.describe(subject, {"behavior": subject})
        for result in results:
            saved.save(result.configuration.key(subject), subject, result)
    return path


def _read(path: Path, subject: str = "a") -> list[TrialResult]:
    with SweepResults.open(path) as saved:
        return sorted(saved.all_of(subject), key=lambda result: result.configuration.number)


def test_what_is_saved_is_found_again_in_another_process(tmp_path: Path) -> None:
    file = _file(tmp_path / "r.db", _result(0), _result(1, outcome="missed"))
    assert _read(file) == [_result(0), _result(1, outcome="missed")]


def test_a_result_is_counted_once_unless_it_is_replaced(tmp_path: Path) -> None:
    file = _file(tmp_path / "r.db", _result(0), _result(0, outcome="missed"))
    assert [each.outcome for each in _read(file)] == ["done"]
    with SweepResults.open(file) as saved:
        saved.save(_result(0).configuration.key("a"), "a", _result(0, outcome="missed"), replace=True)
    assert [each.outcome for each in _read(file)] == ["missed"]


def test_versions_are_kept_apart(tmp_path: Path) -> None:
    file = _file(tmp_path / "r.db", _result(0))
    _file(file, _result(0, outcome="missed"), subject="b")
    assert [each.outcome for each in _read(file, "a")] == ["done"]
    assert [each.outcome for each in _read(file, "b")] == ["missed"]
    with SweepResults.open(file) as saved:
        assert saved.subjects() == {"a": {"behavior": "a"}, "b": {"behavior": "b"}}


def test_only_the_keys_that_are_asked_for_are_found(tmp_path: Path) -> None:
    file = _file(tmp_path / "r.db", _result(0), _result(1))
    key = _result(1).configuration.key("a")
    with SweepResults.open(file) as saved:
        assert list(saved.of("a", [key, "unknown"])) == [key]
        assert saved.of("b", [key]) == {}


def test_what_is_found_is_all_that_is_read(tmp_path: Path) -> None:
    """A search asks for one batch after the other, of a file that grows."""
    file = _file(tmp_path / "r.db", _result(0), _result(1))
    damaged = sqlite3.connect(file)
    damaged.execute("UPDATE results SET result = 'no result' WHERE key = ?", (_result(0).configuration.key("a"),))
    damaged.commit()
    damaged.close()
    with SweepResults.open(file) as saved:
        assert list(saved.of_design("a", [_result(1).configuration])) == [1]
        with pytest.raises(FlexcellError, match="is damaged"):
            saved.of_design("a", [_result(0).configuration])


def test_a_design_of_more_runs_than_a_query_has_values_is_found(tmp_path: Path) -> None:
    designed = [_result(number).configuration for number in range(1201)]
    file = _file(tmp_path / "r.db", *(_result(number) for number in (0, 499, 500, 999, 1000, 1200)))
    with SweepResults.open(file) as saved:
        assert sorted(saved.of_design("a", designed)) == [0, 499, 500, 999, 1000, 1200]


def test_parts_are_merged_and_equal_results_counted_once(tmp_path: Path) -> None:
    first = _file(tmp_path / "1.db", _result(0), _result(1))
    second = _file(tmp_path / "2.db", _result(1, wall_s=9.0), _result(2))
    with SweepResults.open(tmp_path / "all.db") as merged:
        assert merged.merge([first, second]) == 3
        assert merged.merge([first, second]) == 0
        assert merged.subjects() == {"a": {"behavior": "a"}}
    assert [each.configuration.number for each in _read(tmp_path / "all.db")] == [0, 1, 2]


def test_machines_that_disagree_are_not_merged(tmp_path: Path) -> None:
    first = _file(tmp_path / "1.db", _result(0), _result(1))
    second = _file(tmp_path / "2.db", _result(1, outcome="missed"), _result(2))
    with (
        SweepResults.open(first) as merged,
        pytest.raises(FlexcellError, match="configuration 1 has ended differently"),
    ):
        merged.merge([second])
    # Not even the results before the one that differs.
    assert [each.configuration.number for each in _read(first)] == [0, 1]


def test_costs_are_no_part_of_a_result() -> None:
    assert without_costs(_result(0, wall_s=1.0)) == without_costs(_result(0, wall_s=2.0))
    assert without_costs(_result(0)) != without_costs(_result(0, outcome="missed"))


def test_a_missing_part_is_named(tmp_path: Path) -> None:
    with SweepResults.open(tmp_path / "all.db") as merged, pytest.raises(FlexcellError, match="there is no such file"):
        merged.merge([tmp_path / "none.db"])


@pytest.mark.parametrize("content", [b"no database", b"SQLite format 3\x00" + bytes(100)])
def test_a_file_that_is_no_database_is_refused_and_kept(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "r.db"
    file.write_bytes(content)
    with pytest.raises(FlexcellError, match=r"r.db: results cannot be opened"):
        SweepResults.open(file)
    assert file.read_bytes() == content


def test_a_database_of_something_else_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "r.db"
    other = sqlite3.connect(file)
    other.execute("CREATE TABLE results (key TEXT)")
    other.commit()
    other.close()
    with pytest.raises(FlexcellError, match="results cannot be opened"):
        SweepResults.open(file)


@pytest.mark.parametrize("text", ["", "{}", "[1", '{"configuration": 3}', "\x00"])
def test_a_damaged_result_is_named(tmp_path: Path, text: str) -> None:
    file = _file(tmp_path / "r.db", _result(0))
    connection = sqlite3.connect(file)
    connection.execute("UPDATE results SET result = ?", (text,))
    connection.commit()
    connection.close()
    with SweepResults.open(file) as saved, pytest.raises(FlexcellError, match="is damaged"):
        saved.all_of("a")


def test_a_result_survives_json(tmp_path: Path) -> None:
    result = _result(3)
    assert msgspec.json.decode(msgspec.json.encode(result), type=TrialResult) == result


def test_a_file_that_is_read_only_is_no_other_one_and_stays_as_it_is(tmp_path: Path) -> None:
    before = time.time()
    with SweepResults.read(_file(tmp_path / "a.db", _result(0))) as saved:
        assert [each.outcome for each in saved.all_of("a")] == ["done"]
        assert before <= saved.saved_unix_s("a") <= time.time()
        assert saved.saved_unix_s("b") == 0.0
    for content in (b"", b"no results"):
        other = tmp_path / "other.db"
        other.write_bytes(content)
        with pytest.raises(FlexcellError), SweepResults.read(other) as saved:
            saved.subjects()
        assert other.read_bytes() == content
    with pytest.raises(FlexcellError):
        SweepResults.read(tmp_path / "gone.db")
    assert not (tmp_path / "gone.db").exists()
