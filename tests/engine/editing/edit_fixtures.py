"""Texts and edits for tests: what comes out, and the difference in lines."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from textwrap import dedent
from typing import Any

import msgspec

from engine.editing import AnyEdit, DocumentAnalysis, ProjectContext, apply_edits
from engine.editing.draft_cache import EditAnswer
from engine.registry import load_states
from tests.engine.check.data_states import CATALOGUE as DATA_STATES
from tests.engine.fake_states import CATALOGUE

STATES = {**load_states(), **CATALOGUE, **DATA_STATES}
NOWHERE = Path("no-such-project")


def context(folder: Path = NOWHERE) -> ProjectContext:
    """What is known around a document in a folder."""
    return ProjectContext(STATES, folder, folder)


def read_edits(raw: Sequence[object]) -> tuple[list[AnyEdit], str | None]:
    """Edits from plain data, as the server reads them; without any, why it would take none of them."""
    try:
        return msgspec.convert(raw, list[AnyEdit]), None
    except msgspec.ValidationError as error:
        return [], str(error)


def edited(text: str, *edits: dict[str, Any], file: str = "x.yaml", folder: Path = NOWHERE) -> str:
    """Apply edits that must not be refused."""
    made, refusal = read_edits(edits)
    assert refusal is None, refusal
    done = apply_edits(dedent(text), made, file=file, context=context(folder))
    assert done.refused is None, done.refused
    return done.text


def changed(text: str, *edits: dict[str, Any]) -> tuple[str, ...]:
    """The paths that edits made or changed."""
    made, _ = read_edits(edits)
    return apply_edits(dedent(text), made, file="x.yaml", context=context()).changed


def refusal(text: str, *edits: dict[str, Any]) -> str:
    """The words in which edits are refused; the text stays as it was."""
    made, wrong = read_edits(edits)
    assert wrong is None
    done = apply_edits(dedent(text), made, file="x.yaml", context=context())
    assert done.refused is not None
    assert done.text == dedent(text)
    assert done.changed == ()
    return done.refused.message


def difference(before: str, after: str) -> list[str]:
    """The lines that went and came, in order, without the indentation they share."""
    lines = difflib.unified_diff(dedent(before).split("\n"), after.split("\n"), n=0, lineterm="")
    return [line for line in lines if not line.startswith(("---", "+++", "@@"))]


def analysis_of(answer: EditAnswer) -> DocumentAnalysis:
    """Return what an answer says of the text after its edits."""
    return DocumentAnalysis(**{each.name: getattr(answer, each.name) for each in fields(DocumentAnalysis)})
