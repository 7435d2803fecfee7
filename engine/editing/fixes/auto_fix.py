"""Applies the safe fixes of a text one by one; each is kept only if the check confirms it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from engine.editing.analysis.diagnostics import findings_of
from engine.editing.edits.apply import apply_edits
from engine.editing.edits.edit import RemoveNodes
from engine.editing.fixes.fix import Fix
from engine.editing.fixes.fix_registry import fixes_of
from engine.editing.project_context import ProjectContext
from engine.library.behavior_library import FindingView

MAX_ROUNDS = 200
"""Maximum number of checks of one text."""
_DEEPEST = 4
"""Maximum number of rounds in which follow-up findings are fixed before the fixes must be an improvement."""
_Key = tuple[str, str, str]
AppliedFix = tuple[FindingView, Fix]


@dataclass(frozen=True, kw_only=True)
class FixResult:
    """A fixed text: the applied fixes in order, and the remaining findings with the fixes to choose from."""

    text: str
    fixed: tuple[AppliedFix, ...] = ()
    left: tuple[tuple[FindingView, tuple[Fix, ...]], ...] = ()


def fix_text(text: str, *, file: Path, context: ProjectContext, likely: bool = False) -> FixResult:
    """Apply the safe fixes of a text.

    A fix is kept if its finding is resolved and there are fewer findings and no more errors than before, possibly
    after its follow-up findings are fixed as well: once an unknown state is corrected, its parameters are checked.

    Args:
        text: The document.
        file: The file of the document.
        context: The states and behaviors around it.
        likely: If no fix is safe, apply the first that the editor offers, but none that deletes nodes.
    """
    work = _Work(text, file, context, likely=likely)
    work.make()
    offered = work.offered()
    left = tuple((finding, offered[index]) for index, finding in enumerate(work.findings))
    return FixResult(text=work.text, fixed=tuple(work.fixed), left=left)


class _Work:
    def __init__(self, text: str, file: Path, context: ProjectContext, *, likely: bool) -> None:
        self.text: str = text
        self.fixed: list[AppliedFix] = []
        self._file = file
        self._context = context
        self._likely = likely
        self._tried: set[tuple[_Key, str]] = set()
        self._rounds = 0
        self.findings = self._check(text)

    def make(self) -> None:
        """Apply all compatible fixes together, then the others one by one."""
        while self._attempt(self._due()):
            pass
        while self._rounds < MAX_ROUNDS:
            due = next((each for each in self._due() if self._mark(each)), None)
            if due is None:
                return
            if self._attempt([due]):
                self._tried.clear()

    def offered(self) -> tuple[tuple[Fix, ...], ...]:
        """Return the fixes that the editor offers for each finding."""
        return fixes_of(self.text, self.findings, file=str(self._file), context=self._context)

    def _due(self) -> list[AppliedFix]:
        chosen = zip(self.findings, map(self._chosen, self.offered()), strict=True)
        return [(finding, fix) for finding, fix in chosen if fix is not None]

    def _chosen(self, fixes: Sequence[Fix]) -> Fix | None:
        return next(self._candidates(fixes), None)

    def _candidates(self, fixes: Sequence[Fix]) -> Iterator[Fix]:
        yield from (fix for fix in fixes if fix.sure)
        if self._likely:
            yield from (fix for fix in fixes if not any(isinstance(edit, RemoveNodes) for edit in fix.edits))

    def _mark(self, due: AppliedFix) -> bool:
        """Record that a fix is tried; False if it was tried already since the last change."""
        key = (_key(due[0]), due[1].title)
        is_new = key not in self._tried
        self._tried.add(key)
        return is_new

    def _attempt(self, due: Sequence[AppliedFix]) -> bool:
        """Apply fixes together, and those of follow-up findings; undo them and return False if there is no gain."""
        text, findings, fixed = self.text, self.findings, list(self.fixed)
        for _ in range(_DEEPEST):
            if not due or not self._apply(due):
                break
            if len(self.findings) < len(findings) and _errors(self.findings) <= _errors(findings):
                return True
            due = self._due()
        self.text, self.findings, self.fixed = text, findings, fixed
        return False

    def _apply(self, due: Sequence[AppliedFix]) -> bool:
        """Apply fixes unconditionally; False if they cannot be applied, or none resolves its finding."""
        if self._rounds >= MAX_ROUNDS:
            return False
        edits = [edit for _, fix in due for edit in fix.edits]
        done = apply_edits(self.text, edits, file=str(self._file), context=self._context)
        if done.refused is not None or done.text == self.text:
            return False
        self.text, self.findings = done.text, self._check(done.text)
        there = {_key(finding) for finding in self.findings}
        gone = [each for each in due if _key(each[0]) not in there]
        self.fixed += gone
        return bool(gone)

    def _check(self, text: str) -> tuple[FindingView, ...]:
        self._rounds += 1
        return findings_of(text, file=self._file, context=self._context)


def _key(finding: FindingView) -> _Key:
    return finding.code, finding.path, finding.message


def _errors(findings: Sequence[FindingView]) -> int:
    return sum(finding.severity == "error" for finding in findings)
