"""A behavior of another cell as a new document for this one, with the findings that it would have."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import cast

import msgspec

from engine.check import check_survey
from engine.document.behavior import Behavior
from engine.document.cell import Cell, load_cell
from engine.document.loader import parse_behavior, survey_behavior
from engine.document.text.yaml_source import DataPath
from engine.editing.adaptation.name_mapping import CellThings, Choices, MappedName, map_names
from engine.editing.adaptation.name_uses import NameUse, NameUses, UndecidedName
from engine.editing.analysis.diagnostics import finding_view
from engine.editing.project_context import ProjectContext
from engine.editing.text.draft import Draft
from engine.editing.text.outline import Outline
from engine.errors import DocumentError
from engine.library.behavior_library import FindingView


class NewDocument(msgspec.Struct, frozen=True, kw_only=True):
    """A document to write: its file, its text, and the file that it is a copy of."""

    file: Path
    text: str
    original: Path


class AdaptationPlan(msgspec.Struct, frozen=True, kw_only=True):
    """What a behavior becomes in another cell.

    Attributes:
        own_cell: The name of the cell that the behavior is written for.
        cell: The name of the other cell.
        names: What becomes of each name.
        undecided: Expressions that make names of the own cell in a run; they stay as they are.
        findings: Those of the check of the adapted behavior in the other cell.
    """

    own_cell: str
    cell: str
    names: tuple[MappedName, ...]
    undecided: tuple[UndecidedName, ...]
    findings: tuple[FindingView, ...]


class AdaptedBehavior(msgspec.Struct, frozen=True, kw_only=True):
    """A behavior for another cell, not written yet.

    `documents` are the adapted behavior, then copies of the behaviors inside it that name things of its own cell.
    """

    name: str
    plan: AdaptationPlan
    documents: tuple[NewDocument, ...]


def adapt(
    text: str, *, file: Path, output: Path, name: str = "", cell: Cell, context: ProjectContext, choices: Choices
) -> AdaptedBehavior:
    """Return a behavior as it would be for another cell; nothing is written.

    Args:
        text: The behavior.
        file: Its file.
        output: The file of the new document.
        name: The name of the new behavior; made of the old name and that of the cell if empty.
        cell: The other cell.
        context: The states and stores around it.
        choices: What names become; others are proposed.

    Raises:
        DocumentError: the behavior or its cell cannot be read, or it names no cell.
        FlexcellError: a choice is for no name of the behavior, or the other cell has no such thing.
    """
    behavior = parse_behavior(text, file=file)
    if behavior.cell_file is None:
        hint = "it can be started in every cell"
        raise DocumentError("this behavior names no cell", where=str(file), hint=hint)
    own = load_cell(behavior.cell_file)
    reader = NameUses(own, context.signature)
    uses = {each.file.resolve(): reader.of(each) for each in _with_referred(behavior)}
    stored = context.stored(cell.file.resolve())
    names = map_names(
        [use for some in uses.values() for use in some], CellThings(own), CellThings(cell, stored), choices
    )
    name = name or _new_name(behavior.name, cell.name)
    writing = _Writing(uses, names, cell, behavior, text, output)
    documents = writing.documents(name)
    survey = survey_behavior(
        output,
        documents[0].text,
        within=context.project,
        unwritten={each.file.resolve(): each.text for each in documents[1:]},
    )
    findings = check_survey(survey, output, context.catalogue, stored)
    plan = AdaptationPlan(
        own_cell=own.name,
        cell=cell.name,
        names=names,
        undecided=tuple(dict.fromkeys(reader.undecided)),
        findings=tuple(finding_view(finding, output) for finding in findings),
    )
    return AdaptedBehavior(name=name, plan=plan, documents=documents)


def proposed_file(file: Path, cell: Cell) -> Path:
    """Return a free file for the adapted behavior, beside its original."""
    return _free(file.with_name(f"{file.stem}_{cell.name}{file.suffix}"))


def _free(file: Path, taken: Iterable[Path] = ()) -> Path:
    numbered, number = file, 2
    while numbered.exists() or numbered in taken:
        numbered = file.with_name(f"{file.stem}_{number}{file.suffix}")
        number += 1
    return numbered


def _with_referred(behavior: Behavior) -> list[Behavior]:
    """Return a behavior and all that it refers to, each file once."""
    found: dict[Path, Behavior] = {}
    due = [behavior]
    while due:
        each = due.pop()
        if found.setdefault(each.file.resolve(), each) is each:
            due += each.references.values()
    return list(found.values())


class _Writing:
    """The new texts: the adapted behavior, and copies of those inside it in which a name changes."""

    def __init__(
        self,
        uses: Mapping[Path, Sequence[NameUse]],
        names: Sequence[MappedName],
        cell: Cell,
        behavior: Behavior,
        text: str,
        output: Path,
    ) -> None:
        self._uses = uses
        self._targets = {(each.kind, each.name): each.target for each in names if each.target}
        self._cell = cell
        self._behavior = behavior
        self._text = text
        self._output = output
        self._made: dict[Path, NewDocument] = {}
        self._same: set[Path] = set()

    def documents(self, name: str) -> tuple[NewDocument, ...]:
        written = self._written(self._behavior, self._text, self._output, name)
        main = NewDocument(file=self._output, text=written, original=self._behavior.file)
        return (main, *self._made.values())

    def _copy(self, behavior: Behavior) -> Path:
        """Return the file to refer to: a copy in which names have changed, or the original."""
        original = behavior.file.resolve()
        if original in self._made:
            return self._made[original].file
        if original in self._same:
            return original
        changes = any(self._value(use) is not None for use in self._uses[original])
        copied = [self._copy(each) != each.file.resolve() for each in behavior.references.values()]
        if not changes and not any(copied):
            self._same.add(original)
            return original
        taken = [each.file for each in self._made.values()]
        output = _free(
            original.with_name(f"{original.stem}_{self._cell.name}{original.suffix}"), [*taken, self._output]
        )
        text = original.read_text(encoding="utf-8")
        made = NewDocument(file=output, text=self._written(behavior, text, output, ""), original=original)
        self._made[original] = made
        return output

    def _written(self, behavior: Behavior, text: str, output: Path, name: str) -> str:
        draft = Draft(text, file=str(output))
        for use in self._uses[behavior.file.resolve()]:
            value = self._value(use)
            if value is not None:
                _put(draft.data, use.keys, value)
        draft.data["name"] = name or _new_name(behavior.name, self._cell.name)
        if behavior.document.cell is not None:
            draft.data["cell"] = _relative(self._cell.file.resolve(), output)
        for ref in Outline(draft.data).refs.values():
            referred = behavior.references.get(str(ref.data.get("behavior")))
            if referred is not None:
                ref.data["behavior"] = _relative(self._copy(referred), output)
        return draft.text()

    def _value(self, use: NameUse) -> object:
        """Return what is written in the place of a name; None if it stays."""
        target = self._targets.get((use.kind, use.name))
        if target is None or target == use.name:
            return None
        value = target.partition("/")[2] if use.below else target
        return int(value) if use.kind in ("output", "input") and value.isdigit() else value


def _put(data: object, keys: DataPath, value: object) -> None:
    for key in keys[:-1]:
        data = cast("dict[str | int, object]", data)[key]
    cast("dict[str | int, object]", data)[keys[-1]] = value


def _new_name(name: str, cell: str) -> str:
    return f"{name} ({cell})" if " " in name else f"{name}_{cell}"


def _relative(file: Path, document: Path) -> str:
    return Path(os.path.relpath(file, document.resolve().parent)).as_posix()
