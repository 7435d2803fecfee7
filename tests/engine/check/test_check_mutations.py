"""Whatever is written into a document, the check answers with findings and never breaks."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, cast

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from engine.check import CODES, check_file
from engine.cli.commands.check import findings_of
from engine.document import load_source
from engine.registry import load_states
from tests.engine.check.data_states import CATALOGUE as DATA_STATES
from tests.engine.check.random_behaviors import behaviors
from tests.tiers import examples

ROOT = Path(__file__).resolve().parents[3]
CATALOGUE = {**load_states(), **DATA_STATES, "tests.engine.check.data_states:Put": DATA_STATES["data.Put"]}
SHIPPED = [
    cast("dict[str, Any]", load_source(file).data)
    for file in sorted((ROOT / "behaviors").rglob("*.yaml"))
    if "root" in cast("dict[str, Any]", load_source(file).data)
]
SCALARS = st.sampled_from(
    [
        None,
        True,
        0,
        -1,
        1,
        2.5,
        "",
        "x",
        "y",
        "k",
        "root",
        "${k}",
        "${k + 1}",
        "${",
        "${'a' + 1}",
        "success",
        "1 s",
        "a:b",
    ]
)
VALUES: st.SearchStrategy[Any] = (
    SCALARS | st.lists(SCALARS, max_size=2) | st.dictionaries(st.sampled_from(["x", "k", "state"]), SCALARS)
)
NODES: st.SearchStrategy[Any] = st.sampled_from(
    [
        {"state": "flow.Decide", "with": {"when": "${k}"}},
        {"state": "motion.MoveJoints", "with": {"robot": "left", "target": {"entry": "k"}}},
        {"state": "tests.engine.check.data_states:Put", "with": {"value": "${k}"}},
        {"foreach": {"items": "${k}", "child": {"state": "data.Choose"}}},
        {"tree": {"sequence": [{"behaviour": "py_trees.behaviours:Success"}, {"state": "data.Choose"}]}},
        {"behavior": "part.yaml", "in": {"k": "k"}, "out": {"m": "k"}},
        {"priority": {"initial": "x", "states": {}}},
    ]
)


def places(value: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Return the ways to everything inside a document."""
    found = [path] if path else []
    if isinstance(value, dict):
        for key, inner in cast("dict[str, Any]", value).items():
            found += places(inner, (*path, key))
    elif isinstance(value, list):
        for number, inner in enumerate(cast("list[Any]", value)):
            found += places(inner, (*path, number))
    return found


def changed(document: Any, path: tuple[str | int, ...], how: str, value: object) -> Any:
    """Return a copy in which one place is replaced, removed, or called by another name."""
    copy = json.loads(json.dumps(document))
    around: Any = copy
    for step in path[:-1]:
        around = around[step]
    last: Any = path[-1]
    if how == "replace":
        around[last] = value
    elif how == "remove":
        del around[last]
    elif isinstance(last, str):
        around[str(value)] = around.pop(last)
    return copy


@settings(
    max_examples=examples(30, nightly=200),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.large_base_example],
)
@given(st.data())
def test_a_document_with_anything_in_it_gives_findings_and_no_exception(
    tmp_path_factory: Any, data: st.DataObject
) -> None:
    """Up to three changes to a random behavior, or to one that comes with the project."""
    document = data.draw(behaviors() | st.sampled_from(SHIPPED))
    for _ in range(data.draw(st.integers(1, 3))):
        path = data.draw(st.sampled_from(places(document)))
        how = data.draw(st.sampled_from(["replace", "replace", "remove", "rename"]))
        document = changed(
            document, path, how, data.draw(VALUES | NODES if how == "replace" else st.sampled_from(["x", "k"]))
        )
    folder = tmp_path_factory.mktemp("mutated")
    for name in ("cells", "entries"):
        (folder.parent / name).mkdir(exist_ok=True)
        for shipped in (ROOT / "behaviors" / name).glob("*.yaml"):
            (folder.parent / name / shipped.name).write_bytes(shipped.read_bytes())
    (folder / "part.yaml").write_text(json.dumps(data.draw(behaviors())), encoding="utf-8")
    file = folder / "main.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    findings = check_file(file, CATALOGUE)
    assert {finding.code for finding in findings} <= set(CODES)
    assert all(finding.position.line >= 1 for finding in findings)
    assert findings == check_file(file, CATALOGUE)


CELLS = [
    cast("dict[str, Any]", load_source(file).data)
    for folder in ("cells", "entries")
    for file in sorted((ROOT / "behaviors" / folder).glob("*.yaml"))
]
ODD: st.SearchStrategy[Any] = VALUES | st.sampled_from(["panda", "./x", "../x/y", {"kind": "x"}, [1e300] * 3, -400])


@settings(
    max_examples=examples(30, nightly=300),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(st.data())
def test_a_cell_with_anything_in_it_gives_findings_and_no_exception(tmp_path_factory: Any, data: st.DataObject) -> None:
    """Up to three changes to a cell, or to entries, that come with the project."""
    document = data.draw(st.sampled_from(CELLS))
    for _ in range(data.draw(st.integers(1, 3))):
        path = data.draw(st.sampled_from(places(document)))
        how = data.draw(st.sampled_from(["replace", "replace", "remove", "rename"]))
        document = changed(document, path, how, data.draw(ODD if how == "replace" else st.sampled_from(["x", "k"])))
    file = tmp_path_factory.mktemp("mutated") / "cell.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    findings = findings_of(file, CATALOGUE)
    assert {finding.code for finding in findings} <= set(CODES)
    assert all(finding.position.line >= 1 for finding in findings)
