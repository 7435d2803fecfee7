"""Checks the policies of nodes: retry, autonomy, resume, guard and rounds."""

from __future__ import annotations

from collections.abc import Iterator

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.check.flow.key_reads import conditions
from engine.document.count import whole_number
from engine.document.expression.expression import Template
from engine.errors import ExpressionError
from engine.wording.suggestions import did_you_mean

_RESUME = ("rerun", "ask")


def check_policies(subject: AnalyzedBehavior) -> Iterator[Finding]:
    """Find settings that have no effect, block a run, or are invalid."""
    for placed in subject.due:
        node = placed.node
        if node.retry is not None and node.retry.child is None and not node.retry.errors and not node.retry.outcomes:
            message = "this `retry` has no effect: it names no `outcomes`, and `errors` is false"
            yield subject.finding("idle-retry", message, placed.path, "retry", at_key=True)
        for outcome, level in node.autonomy.items():
            if level == "full":
                message = f"`{outcome}` requires `full`, the highest level: it never passes without the operator"
                hint = "require at most `high`, unless every run has to ask the operator"
                yield subject.finding(
                    "autonomy-never-passes", message, placed.path, "autonomy", outcome, hint=hint, at_key=True
                )
        if node.resume is not None:
            yield from _check_resume(subject, placed, node.resume)
        for keys, found in conditions(placed).items():
            if isinstance(found, Template) and not found.names:
                yield from _check_constant(subject, placed, keys, found)


def _check_resume(subject: AnalyzedBehavior, placed: NodeAt, resume: str) -> Iterator[Finding]:
    outcomes = subject.outcomes.get(placed.path)
    if outcomes is None or resume in (*_RESUME, *outcomes):
        return
    message = f"`{resume}` is not a valid `resume` value of `{placed.name}`"
    hint = did_you_mean(resume, (*_RESUME, *outcomes))
    yield subject.finding("bad-resume", message, placed.path, "resume", hint=hint)


def _check_constant(
    subject: AnalyzedBehavior, placed: NodeAt, keys: tuple[str, ...], found: Template
) -> Iterator[Finding]:
    """Check constants: a guard that is always open or closed, items that are not a list."""
    try:
        value = found.evaluate({})
    except ExpressionError as error:
        yield subject.finding("type-mismatch", error.message, placed.path, *keys, hint=error.hint or "")
        return
    key = keys[-1]
    if key == "when":
        if not isinstance(value, bool):
            message = f"the guard expects true or false, but gets {value!r}"
            hint = f"write `${{{value}}}`" if isinstance(value, str) else "write a comparison"
            yield subject.finding("type-mismatch", message, placed.path, *keys, hint=hint)
            return
        message = f"this guard is always {'open' if value else 'closed'}"
        hint = "remove it" if value else "make it depend on a parameter or a userdata key"
        yield subject.finding("constant-guard", message, placed.path, *keys, hint=hint)
    elif key == "times" and whole_number(value) is None:
        message = f"`times` expects an integer of 0 or more, but gets {value!r}"
        hint = f"write `${{{value}}}`" if isinstance(value, str) else ""
        yield subject.finding("type-mismatch", message, placed.path, *keys, hint=hint)
    elif key == "items" and not isinstance(value, list):
        message = f"`items` expects a list, but gets {value!r}"
        hint = f"write `${{{value}}}`" if isinstance(value, str) else ""
        yield subject.finding("type-mismatch", message, placed.path, *keys, hint=hint)
