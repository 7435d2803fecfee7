"""The behaviors of a project folder: found, loaded and checked, and reloaded when a file changes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec

from engine.check import (
    CellFit,
    Finding,
    cell_fit,
    check_survey,
    invalid_document_finding,
    parameter_naming,
    read_beside,
)
from engine.document import Behavior, Cell, load_source, survey_behavior
from engine.errors import ControlError, DocumentError, Position
from engine.library.behavior_graph import GraphNode, new_graph
from engine.library.usages import Usages, UsedKind, find_usages
from engine.runtime.plan import Catalogue
from engine.wording.suggestions import did_you_mean

_SUFFIXES = (".yaml", ".yml", ".json")


class ParameterView(msgspec.Struct, frozen=True, kw_only=True):
    """One parameter for a form."""

    name: str
    schema: dict[str, object]
    required: bool


class FindingView(msgspec.Struct, frozen=True, kw_only=True):
    """One finding with its position in the document."""

    severity: str
    code: str
    message: str
    path: str
    line: int
    column: int
    hint: str


class BehaviorView(msgspec.Struct, frozen=True, kw_only=True):
    """A behavior for the dashboard's list and graph; `graph` is None when the behavior cannot be read."""

    id: str
    name: str
    description: str
    parameters: tuple[ParameterView, ...] = ()
    findings: tuple[FindingView, ...] = ()
    graph: GraphNode | None = None
    view: dict[str, tuple[float, float]] = {}
    success: tuple[str, ...] = ()
    fit: CellFit = CellFit()
    """Whether it can be started in the connected cell."""

    @property
    def errors(self) -> int:
        """Number of findings that prevent a run."""
        return sum(finding.severity == "error" for finding in self.findings)

    @property
    def warnings(self) -> int:
        """Number of findings that do not prevent a run."""
        return len(self.findings) - self.errors


@dataclass(frozen=True, kw_only=True)
class _Read:
    stamps: Mapping[Path, int]
    view: BehaviorView
    behavior: Behavior | None
    surveyed: Behavior | None = None
    """What can be read of the document, also when it has mistakes and cannot be run."""


class Library:
    """The behaviors under `project`, read again when a file changes; ids are paths relative to it with `/`.

    Thread-safe: threads that need the same changed file at once may each read it, and one result is kept.

    Args:
        project: The folder of the project.
        catalogue: The states by name.
        cell: The connected cell; None without one.
    """

    def __init__(self, project: Path, catalogue: Catalogue, *, cell: Cell | None = None) -> None:
        self.catalogue = catalogue
        self._cell = cell
        self._project = project.resolve()
        self._read: dict[str, _Read] = {}

    def forget(self) -> None:
        """Read and check every behavior again when it is asked for: the states have changed."""
        self._read = {}

    def views(self) -> tuple[BehaviorView, ...]:
        """Return all behaviors sorted by id; an unreadable one is listed with its error."""
        return tuple(self._fresh(behavior_id).view for behavior_id in sorted(self._ids()))

    def view(self, behavior_id: str) -> BehaviorView:
        """Return one behavior.

        Raises:
            DocumentError: no document of the project has this id.
        """
        return self._fresh(self._known(behavior_id)).view

    def behavior(self, behavior_id: str) -> Behavior:
        """Return one behavior, ready to run.

        Raises:
            DocumentError: there is none, or it has errors; the message is the first error.
        """
        read = self._fresh(self._known(behavior_id))
        for finding in read.view.findings:
            if finding.severity == "error":
                where = Position(file=behavior_id, line=finding.line, column=finding.column)
                raise DocumentError(finding.message, where=where, hint=finding.hint or None)
        if read.behavior is None:
            raise DocumentError("this behavior cannot be read", where=behavior_id)
        return read.behavior

    def usages(self, kind: UsedKind, name: str) -> Usages:
        """Return where the behaviors of the project, as their files say, use something."""
        behaviors = [(behavior_id, self._fresh(behavior_id).surveyed) for behavior_id in sorted(self._ids())]
        return find_usages(behaviors, self.catalogue, kind, name)

    def require_fit(self, behavior_id: str) -> None:
        """Reject a behavior that is written for another cell and cannot be executed in the connected one.

        Raises:
            ControlError: it cannot; the message says why.
            DocumentError: there is no such behavior.
        """
        if obstacle := self.view(behavior_id).fit.obstacle:
            hint = "serve its cell (`flexcell serve --cell`), or write it for this one"
            raise ControlError(obstacle, where=behavior_id, hint=hint)

    def file_of(self, behavior_id: str) -> Path:
        """Return the file of a behavior; raises DocumentError when there is no behavior with this id."""
        return self._project / self._known(behavior_id)

    def id_of(self, file: Path) -> str:
        """Return the id of a behavior by its file.

        Raises:
            DocumentError: the file is not in this project.
        """
        if not file.is_relative_to(self._project):
            hint = f"the project folder is {self._project}"
            raise DocumentError("this behavior belongs to another project", where=file, hint=hint)
        return self._known(file.relative_to(self._project).as_posix())

    def _known(self, behavior_id: str) -> str:
        known = set(self._ids())
        if behavior_id not in known:
            raise DocumentError(f"there is no behavior {behavior_id!r}", hint=did_you_mean(behavior_id, known))
        return behavior_id

    def _ids(self) -> Iterator[str]:
        for file in (self._project / "behaviors").rglob("*"):
            if file.suffix in _SUFFIXES and file.is_file() and file.resolve().is_relative_to(self._project):
                behavior_id = file.relative_to(self._project).as_posix()
                if not self._is_other(behavior_id):
                    yield behavior_id

    def _is_other(self, behavior_id: str) -> bool:
        """Return whether a document is a cell or entries document; an unreadable one counts as a behavior."""
        return not self._fresh(behavior_id).view.id

    def _fresh(self, behavior_id: str) -> _Read:
        read = self._read.get(behavior_id)
        if read is None or any(_stamp(file) != stamp for file, stamp in read.stamps.items()):
            read = self._read[behavior_id] = self._load(behavior_id)
        return read

    def _load(self, behavior_id: str) -> _Read:
        file = self._project / behavior_id
        stamps = {file: _stamp(file)}
        try:
            data = load_source(file).data
            if isinstance(data, dict) and "root" not in data:
                return _Read(stamps=stamps, view=BehaviorView(id="", name="", description=""), behavior=None)
        except DocumentError as error:
            return _Read(
                stamps=stamps, view=_unreadable(behavior_id, (invalid_document_finding(error, file),)), behavior=None
            )
        survey = survey_behavior(file)
        findings = check_survey(survey, file, self.catalogue)
        behavior = survey.behavior
        if behavior is None or survey.mistakes or survey.circles:
            return _Read(stamps=stamps, view=_unreadable(behavior_id, findings), behavior=None, surveyed=behavior)
        others = [inner.file for inner in _all_references(behavior)]
        stamps |= {other: _stamp(other) for other in (*others, *read_beside(behavior))}
        view = self._view(behavior_id, behavior, findings)
        return _Read(stamps=stamps, view=view, behavior=behavior, surveyed=behavior)

    def _view(self, behavior_id: str, behavior: Behavior, findings: tuple[Finding, ...]) -> BehaviorView:
        return BehaviorView(
            id=behavior_id,
            name=behavior.name,
            description=behavior.document.description,
            parameters=tuple(_parameters(behavior, self.catalogue)),
            findings=tuple(sorted(map(_finding, findings), key=lambda finding: (finding.line, finding.column))),
            graph=new_graph(behavior, self.catalogue),
            view=behavior.document.view,
            success=behavior.success,
            fit=cell_fit(behavior, self.catalogue, self._cell),
        )


def _all_references(behavior: Behavior) -> Iterator[Behavior]:
    """Yield the behaviors that a behavior refers to, directly or indirectly, each once."""
    visited: set[int] = set()
    pending = list(behavior.references.values())
    while pending:
        target = pending.pop()
        if id(target) not in visited:
            visited.add(id(target))
            pending += target.references.values()
            yield target


def _stamp(file: Path) -> int:
    try:
        return file.stat().st_mtime_ns
    except OSError:
        return 0  # a deleted file is a change too


def _parameters(behavior: Behavior, catalogue: Catalogue) -> Iterator[ParameterView]:
    naming = parameter_naming(behavior, catalogue)
    for name, parameter in behavior.parameters.items():
        schema = {**parameter.json_schema(), **naming.get(name, {})}
        yield ParameterView(name=name, schema=schema, required=parameter.required)


def _finding(finding: Finding) -> FindingView:
    return FindingView(
        severity=finding.severity,
        code=finding.code,
        message=finding.message,
        path=finding.path,
        line=finding.position.line,
        column=finding.position.column,
        hint=finding.hint or "",
    )


def _unreadable(behavior_id: str, findings: Sequence[Finding]) -> BehaviorView:
    views = tuple(map(_finding, findings))
    return BehaviorView(id=behavior_id, name=Path(behavior_id).name, description="", findings=views)
