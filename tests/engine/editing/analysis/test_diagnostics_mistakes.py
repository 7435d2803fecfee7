"""The editor tells every structural mistake of a text, and reads nothing outside of the project to do so."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.editing import analyze_text
from tests.engine.editing.edit_fixtures import context
from tests.engine.editing.test_fixes import states

WAIT = "{state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}, timeout: {after: 1 s, to: failed}}"


def test_each_mistake_is_a_finding_and_the_check_goes_on(tmp_path: Path) -> None:
    text = states(f"first: {WAIT[:-1]}, flavour: 1}}", f"second: {WAIT.replace('1 s', 'soon')}", f"third: {WAIT}")
    text = text.replace("done: good", "done: second", 1).replace("flow.Wait", "flow.Wiat")
    found = analyze_text(text, file=tmp_path / "x.yaml", context=context(tmp_path))
    assert [(each.code, each.path, each.line) for each in found.findings] == [
        ("invalid-document", "root/first", 9),
        ("invalid-document", "root/second", 10),
        ("unknown-state", "root/third", 11),
    ]
    assert found.graph is not None


def test_a_line_that_is_no_yaml_hides_no_other(tmp_path: Path) -> None:
    """The canvas stays as it was; the list has everything."""
    text = states(f"first: {WAIT[:-1]}", f"second: {WAIT.replace('flow.Wait', 'flow.Wiat')}", "third: {state: *x}")
    found = analyze_text(text, file=tmp_path / "x.yaml", context=context(tmp_path))
    assert found.graph is None
    assert [(each.code, each.line) for each in found.findings] == [
        ("invalid-document", 10),
        ("unknown-state", 10),
        ("invalid-document", 11),
    ]


@pytest.mark.parametrize("key", ["behavior", "behavour"])
def test_what_leads_out_of_the_project_is_not_looked_at(tmp_path: Path, key: str) -> None:
    """However the key is spelled; neither is a cell."""
    project = tmp_path / "project"
    project.mkdir()
    (tmp_path / "secret.yaml").write_text("password: 1\n", encoding="utf-8")
    text = states(f"first: {{{key}: ../secret.yaml, transitions: {{}}}}").replace("root:", "cel: ../secret.yaml\nroot:")
    found = analyze_text(text, file=project / "x.yaml", context=context(project))
    said = str(found.findings)
    assert "`../secret.yaml` leads out of the project" in said
    assert "password" not in said
    assert "secret.yaml:" not in said
