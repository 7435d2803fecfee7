"""A seeded slice of the hostile texts: nothing comes out but findings, refusals and ends of runs, at a bounded cost."""

from __future__ import annotations

import random

from benchmarks.hostile_documents import base_documents, expression_document, mutated_document
from benchmarks.hostile_inputs import PROJECT, HostileInputProbe, hostile_catalogue
from engine.document.expression.cel_expression import MAX_TEXT
from engine.document.expression.step_meter import METER


def test_hostile_expressions_go_through_check_editor_and_run() -> None:
    """Twenty documents; some are refused early, some run."""
    chance = random.Random(1)
    _require_calm(HostileInputProbe(hostile_catalogue()), [expression_document(chance) for _ in range(20)])


def test_mutated_documents_go_through_check_editor_and_run() -> None:
    """Thirty documents, damaged in up to five places."""
    chance = random.Random(2)
    bases = base_documents(PROJECT)
    _require_calm(HostileInputProbe(hostile_catalogue()), [mutated_document(chance, bases) for _ in range(30)])


def _require_calm(made: HostileInputProbe, texts: list[str]) -> None:
    before = METER.spent
    made.pass_through(enumerate(text for text in texts if len(text) < 5 * MAX_TEXT))
    assert [error for tally in made.probes for error in tally.errors] == []
    assert made.checking.refused > 0
    assert made.running.count > 0
    # What the runs on this thread cost, in steps: at most a small part of a second of the loop for each.
    assert METER.spent - before < 100_000 * len(texts)
