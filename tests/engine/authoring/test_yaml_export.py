"""YAML written from behaviors: reads back as the same, byte for byte the same each time, and fits the schema."""

from __future__ import annotations

import json
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from jsonschema import Draft202012Validator

from engine.authoring import Timeout, behavior, is_made_in_python, machine, reference, state, to_yaml, write_behavior
from engine.document import Behavior, load_behavior, parse_behavior, parse_source, write_yaml
from engine.document.schema import SCHEMA_FOLDER
from engine.errors import DocumentError
from tests.engine.authoring.random_steps import BEHAVIORS
from tests.engine.document.example_documents import BEHAVIORS as DOCUMENTS
from tests.engine.document.example_documents import Plain
from tests.engine.fake_states import Give
from tests.tiers import examples

SHIPPED = sorted((Path(__file__).parents[3] / "behaviors").rglob("*.yaml"))
SCHEMA: Any = Draft202012Validator(json.loads((SCHEMA_FOLDER / "behavior.schema.json").read_text(encoding="utf-8")))


@given(BEHAVIORS)
@settings(max_examples=examples(40, nightly=300), suppress_health_check=[HealthCheck.too_slow], deadline=None)
def test_a_behavior_made_in_python_written_and_read_is_the_same(made: Behavior) -> None:
    """The models, the meaning, and the bytes of a second writing."""
    text = to_yaml(made)
    read = parse_behavior(text, file="x.yaml")
    assert read.document == made.document
    assert read.meaning == made.meaning
    assert to_yaml(read) == text


@given(BEHAVIORS)
@settings(max_examples=examples(40, nightly=300), suppress_health_check=[HealthCheck.too_slow], deadline=None)
def test_what_is_written_fits_the_committed_schema(made: Behavior) -> None:
    """So an editor with the schema marks nothing in it."""
    data = parse_source(to_yaml(made), file="x.yaml").data
    assert [error.message for error in SCHEMA.iter_errors(data)] == []


@given(DOCUMENTS)
@settings(max_examples=examples(40, nightly=300), deadline=None)
def test_any_document_written_and_read_is_the_same(document: Plain) -> None:
    """Also one that was never made in Python, and whose defaults were written out."""
    read = parse_behavior(write_yaml(document), file="x.yaml")
    again = parse_behavior(to_yaml(read), file="x.yaml")
    assert (again.document, again.meaning) == (read.document, read.meaning)


@pytest.mark.parametrize("file", [file for file in SHIPPED if "root:" in file.read_text("utf-8")], ids=lambda f: f.stem)
def test_shipped_behaviors_are_written_and_read(file: Path) -> None:
    """In their place, where what they refer to is found."""
    read = load_behavior(file)
    assert parse_behavior(to_yaml(read), file=file).meaning == read.meaning


def test_it_is_written_as_one_would_by_hand() -> None:
    """Description first, what fits on one line, no defaults."""
    made = behavior(
        "rest",
        outcomes=["good"],
        root=machine(
            initial="give",
            states={
                "give": state(
                    Give(outcome="c", after_s=0.0),
                    description="Only waits, and says so at a length that does not fit into one line of a hundred.",
                    transitions={"a": "good", "b": "good", "c": "good"},
                    timeout=Timeout(after="1 min", to="good"),
                ),
            },
        ),
    )
    assert to_yaml(made) == dedent("""\
        flexcell: 1
        name: rest
        outcomes: [good]
        root:
          machine:
            initial: give
            states:
              give:
                description: Only waits, and says so at a length that does not fit into one line of a hundred.
                state: test.Give
                with: {outcome: c}
                transitions: {a: good, b: good, c: good}
                timeout: {after: 1 min, to: good}
    """)


def _work(folder: Path) -> Behavior:
    """A behavior in Python that refers to two more, one of them in a folder below."""
    rest = behavior("rest", outcomes=["a"], root=state(Give()), file=str(folder / "rest.yaml"))
    deep = behavior("deep", outcomes=["a"], root=state(Give()), file=str(folder / "parts" / "deep.yaml"))
    states = {"rest": reference(rest, transitions={"a": "deep"}), "deep": reference(deep, transitions={"a": "a"})}
    root = machine(initial="rest", states=states)
    return behavior("work", outcomes=["a"], root=root, file=str(folder / "work.yaml"))


def test_behaviors_referred_to_are_written_beside_it(tmp_path: Path) -> None:
    """In the folder asked for, which need not be that of the Python file; what is there already is left."""
    made = _work(tmp_path / "python")
    target = tmp_path / "documents"
    assert write_behavior(made, target / "work.yaml") == (
        target / "rest.yaml", target / "parts" / "deep.yaml", target / "work.yaml",
    )  # fmt: skip
    read = load_behavior(target / "work.yaml")
    assert (read.document, read.meaning) == (made.document, made.meaning)
    assert write_behavior(made, target / "work.yaml") == (target / "work.yaml",)
    assert sorted(file.name for file in target.rglob("*.*")) == ["deep.yaml", "rest.yaml", "work.yaml"]
    assert is_made_in_python(made)
    assert not is_made_in_python(read)


def test_nothing_is_replaced_when_a_reference_would_not_be_found(tmp_path: Path) -> None:
    """A document on disk that lies elsewhere is named, and how to help."""
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "inner.yaml").write_text(to_yaml(_work(tmp_path).references["rest.yaml"]), encoding="utf-8")
    inner = load_behavior(tmp_path / "here" / "inner.yaml")
    made = behavior("outer", outcomes=["a"], root=reference(inner), file=str(tmp_path / "here" / "outer.yaml"))
    elsewhere = tmp_path / "outer.yaml"
    elsewhere.write_text("precious", encoding="utf-8")
    with pytest.raises(DocumentError, match=r"outer\.yaml refers to `inner\.yaml`, which does not exist"):
        write_behavior(made, elsewhere)
    assert elsewhere.read_text(encoding="utf-8") == "precious"
    assert write_behavior(made, tmp_path / "here" / "outer.yaml") == (tmp_path / "here" / "outer.yaml",)


def test_no_behavior_is_written_outside_the_folder(tmp_path: Path) -> None:
    """`../` in a reference does not decide where files appear."""
    rest = behavior("rest", outcomes=["a"], root=state(Give()), file=str(tmp_path / "rest.yaml"))
    made = behavior("work", outcomes=["a"], root=reference(rest), file=str(tmp_path / "a" / "work.yaml"))
    with pytest.raises(DocumentError, match=r"refers to `\.\./rest\.yaml`, which does not exist"):
        write_behavior(made, tmp_path / "b" / "work.yaml")
    write_behavior(rest, tmp_path / "rest.yaml")
    assert write_behavior(made, tmp_path / "b" / "work.yaml") == (tmp_path / "b" / "work.yaml",)
