"""Sweep documents."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.sweep import PointsFile, SearchSpec, SweepDocument, load_sweep, parse_sweep, require_address
from engine.errors import DocumentError

HEAD = "flexcell: 1\nbehavior: folder/b.yaml\n"


def test_a_document_is_read(tmp_path: Path) -> None:
    file = tmp_path / "sweep.yaml"
    file.write_text(
        HEAD
        + "factors:\n"
        + "  parameters.speed: {uniform: [0.3, 1.0]}\n"
        + "  displace.bolt.x_m: {normal: {deviation: 0.004}}\n"
        + "  cell.parts.bolt.mass_kg: {log_uniform: [0.05, 0.5]}\n"
        + "  faults: {values: [none, slip.yaml]}\n"
        + "design: {csv: points.csv}\nruns: 500\nrequire: success >= 0.98\ntime: 10 min\n",
        encoding="utf-8",
    )
    sweep = load_sweep(file)
    assert list(sweep.document.factors) == [
        "parameters.speed",
        "displace.bolt.x_m",
        "cell.parts.bolt.mass_kg",
        "faults",
    ]
    assert sweep.document.required_rate == 0.98
    assert sweep.document.design == PointsFile(csv="points.csv")
    assert sweep.resolve("folder/b.yaml") == str(tmp_path / "folder" / "b.yaml")
    assert sweep.resolve("b.py:make") == f"{tmp_path / 'b.py'}:make"


def test_the_least_document_has_a_hundred_random_runs_and_requires_nothing() -> None:
    document = parse_sweep(HEAD, file="sweep.yaml").document
    assert document == SweepDocument(flexcell=1, behavior="folder/b.yaml")
    assert (document.runs, document.design, document.required_rate) == (100, "random", None)


def test_its_text_is_read_back() -> None:
    sweep = parse_sweep(HEAD + "factors: {parameters.a: {values: [1, x]}}\nwidth: 0.1\n", file="sweep.yaml")
    assert parse_sweep(sweep.text, file="sweep.yaml").document == sweep.document


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("runs: 0\n", "sweep.yaml:3:7: `runs`"),
        ("rusn: 4\n", r"sweep.yaml:3:1: unknown key `rusn` \(did you mean runs\?\)"),
        ("require: success > 0.9\n", r"sweep.yaml:3:10: `require`.*success >= 0.98"),
        ("require: success >= 1.5\n", "sweep.yaml:3:10: `require`"),
        ("design: sobel\n", r"sweep.yaml:3:9: `design`"),
        ("design: grid\nwidth: 0.1\n", "sweep.yaml:4:1: only a random design has an interval"),
        ("interval: exact\nwidth: 0.1\n", "sweep.yaml:4:1: only a random design has an interval"),
        ("confidence: 1.0\n", "sweep.yaml:3:13: `confidence`"),
        ("time: soon\n", "sweep.yaml:3:7: `time`"),
    ],
)
def test_a_mistake_is_named_with_its_place(text: str, message: str) -> None:
    with pytest.raises(DocumentError, match=message):
        parse_sweep(HEAD + text, file="sweep.yaml")


@pytest.mark.parametrize(
    ("factor", "message"),
    [
        ("speed: {uniform: [0, 1]}", "4:3: .*parameters.NAME"),
        ("displace.bolt.w_m: {uniform: [0, 1]}", "4:3: .*displace.PART.x_m"),
        ("parameters.a: {}", "4:3: the factor `parameters.a` has no distribution"),
        ("parameters.a: {uniform: [0, 1], values: [1]}", "has `values` and `uniform`"),
        ("parameters.a: {values: []}", "`values`"),
        ("parameters.a: {uniform: [1, 0]}", r"4:27: `uniform` goes from 1 to 0 \(\[least, most\]\)"),
        ("parameters.a: {uniform: [1, 1]}", "`uniform` goes from 1 to 1"),
        ("parameters.a: {log_uniform: [0, 1]}", "`log_uniform` starts above 0"),
        ("parameters.a: {normal: {deviation: 0}}", "`deviation`"),
        ("parameters.a: {values: [1], integer: true}", "`integer` has no effect on `values`"),
        (
            "faults: {uniform: [0, 1]}",
            r"`faults` is varied over names of documents \(values: \[none, my_faults.yaml\]\)",
        ),
        ("faults: {values: [1]}", "`faults` is varied over names of documents"),
        ("seed: {uniform: [0, 9]}", "`seed` is varied over integers from 0"),
        ("seed: {values: [-1]}", "`seed` is varied over integers from 0"),
        ("seed: {values: [true]}", "`seed` is varied over integers from 0"),
    ],
)
def test_a_factor_that_cannot_be_varied_is_refused(factor: str, message: str) -> None:
    with pytest.raises(DocumentError, match=message):
        parse_sweep(f"{HEAD}factors:\n  {factor}\n", file="sweep.yaml")


@pytest.mark.parametrize(
    ("fixed", "factor"),
    [
        ("parameters: {a: 1}", "parameters.a: {uniform: [0, 1]}"),
        ("inputs: {a: 1}", "inputs.a: {values: [1, 2]}"),
        ("faults: f.yaml", "faults: {values: [none]}"),
        ("substitutes: f.yaml", "substitutes: {values: [none]}"),
    ],
)
def test_a_factor_with_a_fixed_value_is_refused(fixed: str, factor: str) -> None:
    with pytest.raises(DocumentError, match="is a factor and has a fixed value too"):
        parse_sweep(f"{HEAD}{fixed}\nfactors:\n  {factor}\n", file="sweep.yaml")


@pytest.mark.parametrize("text", ["speed", "cell.", "cell", "displace.bolt", "faults.x", "parameters.a.b", ""])
def test_what_is_no_address_is_refused_where_it_stands(text: str) -> None:
    with pytest.raises(DocumentError, match=r"points.csv:1: .* is not the address of a factor"):
        require_address(text, where="points.csv:1")


def test_a_search_has_a_default_for_everything() -> None:
    text = HEAD + "factors: {parameters.speed: {uniform: [0, 1]}}\nsearch: {}\n"
    assert parse_sweep(text, file="s.yaml").document.search == SearchSpec()
    assert (SearchSpec().towards, SearchSpec().method, SearchSpec().runs) == ("failure", "cross_entropy", 200)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("search: {}", "a search has nothing to vary"),
        ("factors: {seed: {values: [1, 2]}}\nsearch: {}", "a search has nothing to vary"),
        (
            "factors: {parameters.speed: {uniform: [0, 1]}}\ndesign: sobol\nsearch: {}",
            "starts with configurations",
        ),
        ("factors: {parameters.speed: {uniform: [0, 1]}}\nsearch: {towards: gap_m}", "towards"),
        ("factors: {parameters.speed: {uniform: [0, 1]}}\nsearch: {random_share: 0}", "random_share"),
    ],
)
def test_a_search_that_cannot_be_is_refused_with_its_position(text: str, message: str) -> None:
    with pytest.raises(DocumentError, match=message) as caught:
        parse_sweep(HEAD + text, file="s.yaml")
    assert "s.yaml" in str(caught.value)
