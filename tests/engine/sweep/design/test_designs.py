"""Which configurations a sweep has."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.sweep import Sweep, parse_sweep
from engine.errors import DocumentError
from engine.sweep.design.designs import configurations, run_seed

HEAD = "flexcell: 1\nbehavior: b.yaml\n"
TWO = "factors:\n  parameters.a: {uniform: [0, 1]}\n  parameters.b: {values: [x, y]}\n"


def _sweep(text: str, folder: Path = Path()) -> Sweep:
    return parse_sweep(HEAD + text, file=folder / "sweep.yaml")


@pytest.mark.parametrize("design", ["random", "grid", "latin_hypercube", "sobol"])
def test_a_design_is_the_same_each_time(design: str) -> None:
    sweep = _sweep(f"{TWO}design: {design}\nruns: 20\nseed: 3\n")
    assert configurations(sweep) == configurations(sweep)
    assert [each.number for each in configurations(sweep)] == list(range(20))


@pytest.mark.parametrize("design", ["random", "sobol", "grid"])
def test_a_longer_sweep_starts_with_the_shorter_one(design: str) -> None:
    short = configurations(_sweep(f"{TWO}design: {design}\nruns: 7\n"))
    long = configurations(_sweep(f"{TWO}design: {design}\nruns: 50\n"))
    assert long[:7] == short


@pytest.mark.parametrize("design", ["random", "latin_hypercube", "sobol"])
def test_another_seed_draws_other_values_and_other_seeds(design: str) -> None:
    first = configurations(_sweep(f"{TWO}design: {design}\nruns: 8\nseed: 1\n"))
    second = configurations(_sweep(f"{TWO}design: {design}\nruns: 8\nseed: 2\n"))
    assert not {each.values["parameters.a"] for each in first} & {each.values["parameters.a"] for each in second}
    assert not {each.seed for each in first} & {each.seed for each in second}


def test_a_latin_hypercube_has_one_run_in_each_part_of_each_factor() -> None:
    text = "factors:\n  parameters.a: {uniform: [0, 1]}\n  parameters.c: {uniform: [0, 1]}\n"
    runs = configurations(_sweep(f"{text}design: latin_hypercube\nruns: 32\n"))
    for name in ("parameters.a", "parameters.c"):
        assert sorted(int(32 * float(str(each.values[name]))) for each in runs) == list(range(32))


def test_a_grid_has_every_combination_once_and_then_again_with_other_seeds() -> None:
    text = "factors:\n  parameters.a: {uniform: [0, 1], levels: 2}\n  parameters.b: {values: [x, y]}\n"
    runs = configurations(_sweep(f"{text}design: grid\nruns: 8\n"))
    values = [(each.values["parameters.a"], each.values["parameters.b"]) for each in runs]
    assert values[:4] == [(0.25, "x"), (0.25, "y"), (0.75, "x"), (0.75, "y")]
    assert values[4:] == values[:4]
    assert len({each.seed for each in runs}) == 8


def test_without_factors_only_seeds_differ() -> None:
    runs = configurations(_sweep("runs: 5\n"))
    assert [dict(each.values) for each in runs] == [{}] * 5
    assert len({each.seed for each in runs}) == 5


def test_a_factor_may_be_the_seed() -> None:
    runs = configurations(_sweep("factors: {seed: {values: [7, 9]}}\ndesign: grid\nruns: 2\n"))
    assert [each.seed for each in runs] == [7, 9]


@given(st.integers(0, 2**53), st.integers(0, 10**7))
def test_a_seed_is_kept_by_every_reader_of_json(seed: int, number: int) -> None:
    assert 0 <= run_seed(seed, number) < 2**53


class TestFile:
    def test_each_row_is_a_run(self, tmp_path: Path) -> None:
        (tmp_path / "p.csv").write_text("parameters.a, parameters.b,seed\n0.5,x,4\n\n0.25,y,5\n", encoding="utf-8")
        runs = configurations(_sweep("design: {csv: p.csv}\n", tmp_path))
        assert [(each.seed, each.values["parameters.a"], each.values["parameters.b"]) for each in runs] == [
            (4, 0.5, "x"),
            (5, 0.25, "y"),
        ]

    @pytest.mark.parametrize(
        ("content", "message"),
        [
            (None, "cannot be read"),
            ("", "is empty"),
            ("speed\n1\n", "1: `speed` is not the address of a factor"),
            ("parameters.a\n1,2\n", "2: 2 values for 1 columns"),
            ("parameters.b\nx\n", "has no column `parameters.a`"),
            (b"\xff\xfe\x00", "cannot be read"),
        ],
    )
    def test_a_file_that_is_no_design_is_refused(
        self, tmp_path: Path, content: str | bytes | None, message: str
    ) -> None:
        if content is not None:
            (tmp_path / "p.csv").write_bytes(content.encode() if isinstance(content, str) else content)
        text = "factors: {parameters.a: {uniform: [0, 1]}}\ndesign: {csv: p.csv}\n"
        with pytest.raises(DocumentError, match=message):
            configurations(_sweep(text, tmp_path))


def test_the_key_of_a_run_depends_on_all_but_its_number() -> None:
    first, second = configurations(_sweep(f"{TWO}runs: 2\n"))
    assert first.key("subject") == first.key("subject")
    assert len({first.key("subject"), first.key("other"), second.key("subject")}) == 3
