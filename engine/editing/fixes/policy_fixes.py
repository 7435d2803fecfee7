"""Fixes of settings that have no effect or block a run for ever."""

from __future__ import annotations

from collections.abc import Iterator

from engine.editing.edits.edit import SetField
from engine.editing.fixes.fix import Fix, FixContext, is_typo, similar_names


def constant_guard(place: FixContext) -> Iterator[Fix]:
    """Remove a guard that is always true."""
    if "guard" in place.ref.data and place.finding.message.endswith("open"):
        yield Fix(title="Remove the guard", edits=(SetField(path=place.ref.path, field="guard"),), sure=True)


def idle_retry(place: FixContext) -> Iterator[Fix]:
    """Remove a retry that never applies, or make it apply after errors."""
    retry = place.section("retry")
    if retry:
        again = SetField(path=place.ref.path, field="retry", value={**retry, "errors": True})
        yield Fix(title="Retry after errors", edits=(again,))
        yield Fix(title="Remove the retry", edits=(SetField(path=place.ref.path, field="retry"),))


def autonomy_never_passes(place: FixContext) -> Iterator[Fix]:
    """Require an autonomy level that a run can have."""
    outcome, asked = place.names[0], place.section("autonomy")
    if outcome in asked:
        edit = SetField(path=place.ref.path, field="autonomy", value={**asked, outcome: "high"})
        yield Fix(title=f"Require `high` for `{outcome}`", edits=(edit,))


def bad_resume(place: FixContext) -> Iterator[Fix]:
    """Replace an unknown resume policy with an existing one."""
    known = ("rerun", "ask", *place.session.ends(place.ref).outcomes)
    for right in dict.fromkeys((*similar_names(place.names[0], known), "ask")):
        edit = SetField(path=place.ref.path, field="resume", value=right)
        yield Fix(title=f"Resume with `{right}`", edits=(edit,), sure=is_typo(place.names[0], right, known))
