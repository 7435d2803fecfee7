"""What the names of one cell may become in another one: candidates by kind and ability, and the best of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from difflib import SequenceMatcher
from typing import cast

import msgspec

from engine.cell.cell_names import CellNameKind, CellNames, cell_names
from engine.cell.robot_models import RobotSummary, robot_models, tool_kinds
from engine.check.cell.entry_references import Entries
from engine.document.cell import Cell
from engine.document.cell_bodies import Fixture, PartSpec
from engine.document.entries_document import load_entries
from engine.editing.adaptation.name_uses import NameUse
from engine.errors import DocumentError, FlexcellError
from engine.wording.suggestions import did_you_mean

Choices = Mapping[str, str]
"""The chosen names by `kind:name` or `name`; an empty one keeps the name as it is."""
_ALIKE = 0.6
"""How similar two names must be for one to be proposed for the other, 0 to 1."""
_BELOW: Mapping[str, CellNameKind] = {
    "link": "link", "output": "output", "input": "input", "label": "label", "tool": "tool",
}  # fmt: skip
_ORDER = (
    "robot", "part", "fixture", "frame", "person", "camera", "tool", "link", "output", "input", "label", "planner",
)  # fmt: skip


class NameCandidate(msgspec.Struct, frozen=True, kw_only=True):
    """A name of the other cell, and in words what it is."""

    name: str
    detail: str = ""


class MappedName(msgspec.Struct, frozen=True, kw_only=True):
    """A name of the cell that a behavior is written for, and what it becomes.

    Attributes:
        kind: As `NameUse.kind`.
        name: The name in the own cell.
        detail: In words what it is.
        target: The name in the other cell; empty if nothing is chosen, then it stays as it is.
        reason: In words why this target is proposed, or why none is; empty for a chosen one.
        candidates: What it may become, the best first.
        paths: The nodes that use it; empty for a declaration of the document.
    """

    kind: str
    name: str
    detail: str
    target: str
    reason: str
    candidates: tuple[NameCandidate, ...]
    paths: tuple[str, ...]

    @property
    def key(self) -> str:
        """Its key in `Choices`."""
        return f"{self.kind}:{self.name}"


class CellThings:
    """What a cell has, for comparison with another one; `stored` are the entries of its store, or its seed."""

    def __init__(self, cell: Cell, stored: Entries | None = None) -> None:
        self.cell = cell
        self.names: CellNames = cell_names(cell)
        self.entries: Entries = stored if stored is not None else _seed(cell)
        self._joints = _joint_counts(cell)
        models = robot_models()
        self.robots: dict[str, RobotSummary] = {}
        for name in cell.document.robots if models is not None else ():
            try:
                self.robots[name] = models.summary(cell, name) if models is not None else self.robots[name]
            except FlexcellError:
                continue  # the check of the cell reports the model

    def all(self, kind: str) -> tuple[str, ...]:
        """Return the names of a kind: things in the order of the cell document, others sorted."""
        document = self.cell.document
        things = document.named_things
        if kind in things:
            return tuple(things[kind])
        if kind in _ORDER:
            return tuple(sorted(self.names.by_kind.get(kind, ())))
        return tuple(sorted(self.entries.get(kind, ())))

    def detail(self, kind: str, name: str) -> str:
        """Return in words what a thing is: model, joints and tool of a robot, shape and size of a part."""
        document = self.cell.document
        if kind == "robot" and name in document.robots:
            robot, summary = document.robots[name], self.robots.get(name)
            words = [robot.model.rsplit("/", 1)[-1]]
            words += [f"{len(summary.joints)} joints"] if summary is not None else []
            words += [summary.tool or "no tool"] if summary is not None else []
            return ", ".join(words)
        body = {**document.parts, **document.fixtures}.get(name)
        if body is not None:
            size = f"{' x '.join(f'{edge * 1000:g}' for edge in body.size_m)} mm"
            return f"{body.shape} {body.file if isinstance(body, Fixture) and body.shape == 'mesh' else size}"
        if kind == "joints" and name in self._joints:
            return f"{self._joints[name]} joints"
        return "detects" if name in self.names.by_kind.get("detector", ()) else ""

    def body(self, name: str) -> PartSpec | Fixture | None:
        """Return a part or fixture."""
        return self.cell.document.parts.get(name) or self.cell.document.fixtures.get(name)

    def part_of(self, label: str) -> str:
        """Return the part that a camera calls by a label, `eye/plate`; empty if there is none."""
        camera, _, called = label.partition("/")
        found = self.cell.document.cameras.get(camera)
        labels = found.detect.labels if found is not None and found.detect is not None else {}
        return next((part for part in self.cell.document.parts if labels.get(part, part) == called), "")

    def joint_count(self, entry: str) -> int | None:
        """Return the number of joints of an entry of its seed; None if unknown."""
        return self._joints.get(entry)


def map_names(uses: Sequence[NameUse], own: CellThings, other: CellThings, choices: Choices) -> tuple[MappedName, ...]:
    """Return what each name becomes: as chosen, else as proposed; owners before what is below them.

    Raises:
        FlexcellError: a choice is for no name of the behavior, or the other cell has no such thing.
    """
    grouped: dict[tuple[str, str], list[NameUse]] = {}
    for use in uses:
        grouped.setdefault((use.kind, use.name), []).append(use)
    order = sorted(grouped, key=lambda each: _ORDER.index(each[0]) if each[0] in _ORDER else len(_ORDER))
    mapping = _Mapping(own, other)
    made = tuple(mapping.add(kind, name, grouped[kind, name], _chosen(choices, kind, name)) for kind, name in order)
    for key in choices:
        if not any(key in (each.key, each.name) for each in made):
            known = sorted({each.name for each in made})
            raise FlexcellError(f"the behavior uses no `{key}` of its cell", hint=did_you_mean(key, known))
    return made


def _chosen(choices: Choices, kind: str, name: str) -> str | None:
    return choices.get(f"{kind}:{name}", choices.get(name))


class _Mapping:
    """The names that are mapped so far: later ones depend on their owners, and two things become two."""

    def __init__(self, own: CellThings, other: CellThings) -> None:
        self._own = own
        self._other = other
        self._targets: dict[tuple[str, str], str] = {}

    def add(self, kind: str, name: str, uses: Sequence[NameUse], chosen: str | None) -> MappedName:
        names = self._sorted(kind, name, {use.needs for use in uses})
        if chosen and chosen not in names and kind in _ORDER:
            message = f"`{name}` cannot become `{chosen}` in the cell {self._other.cell.name}"
            raise FlexcellError(message, hint=did_you_mean(chosen, names))
        target, reason = (chosen, "") if chosen is not None else self._proposed(kind, name, names)
        if target:
            self._targets[kind, name] = target
        return MappedName(
            kind=kind,
            name=name,
            detail=self._own.detail(kind, name),
            target=target,
            reason=reason,
            candidates=tuple(NameCandidate(name=each, detail=self._other.detail(kind, each)) for each in names),
            paths=tuple(dict.fromkeys(use.path for use in uses if use.path)),
        )

    def _sorted(self, kind: str, name: str, needs: set[str]) -> list[str]:
        """Return what a name may become, the best first."""
        found = [each for each in self._other.all(kind) if self._is_able(kind, each, needs)]
        if kind in _BELOW:
            owner = self._targets.get(("camera" if kind == "label" else "robot", name.partition("/")[0]))
            found = [each for each in found if owner is None or each.partition("/")[0] == owner]
        if kind in ("output", "input"):
            # A number is written as a number, a use by its name.
            found = [each for each in found if _is_number(each) == _is_number(name)]
        return sorted(found, key=lambda each: -self._score(kind, name, each))

    def _is_able(self, kind: str, name: str, needs: set[str]) -> bool:
        by_kind = self._other.names.by_kind
        due = needs & ({*tool_kinds()} if kind == "robot" else {"detector"} if kind == "camera" else set[str]())
        return all(name in by_kind.get(each, ()) for each in due)

    def _score(self, kind: str, name: str, other: str) -> float:
        """Return how well a name fits, the same name above all; a thing that is taken fits less."""
        rules: Mapping[str, Callable[[str, str], float]] = {
            "robot": self._robots_alike,
            "part": self._bodies_alike,
            "fixture": self._bodies_alike,
            "link": self._links_alike,
            "joints": self._joints_alike,
            "label": self._labels_alike,
        }
        below, there = name.partition("/")[2] or name, other.partition("/")[2] or other
        alike = SequenceMatcher(None, below, there).ratio()
        taken = other in (to for (of, _), to in self._targets.items() if of == kind)
        alike = 10.0 if below == there else alike if alike >= _ALIKE or kind not in _ORDER else 0.0
        return alike + (rules[kind](name, other) if kind in rules else 0.0) - (20.0 if taken else 0.0)

    def _robots_alike(self, name: str, other: str) -> float:
        one, two = self._own.robots.get(name), self._other.robots.get(other)
        if one is None or two is None:
            return 0.0
        models = (things.cell.document.robots[each].model for things, each in ((self._own, name), (self._other, other)))
        return 6.0 * (one.tool == two.tool) + 3.0 * (len(one.joints) == len(two.joints)) + (len({*models}) == 1)

    def _bodies_alike(self, name: str, other: str) -> float:
        one, two = self._own.body(name), self._other.body(other)
        if one is None or two is None or one.shape != two.shape:
            return 0.0
        if one.shape == "mesh":
            return 3.0 if one == two else 2.0
        return 2.0 + sum(min(a, b) / max(a, b) for a, b in zip(one.size_m, two.size_m, strict=True)) / len(one.size_m)

    def _links_alike(self, name: str, other: str) -> float:
        bases = [
            (robot := things.robots.get(each.partition("/")[0])) is not None and each.endswith(f"/{robot.base_link}")
            for things, each in ((self._own, name), (self._other, other))
        ]
        return 5.0 if all(bases) else 0.0

    def _labels_alike(self, name: str, other: str) -> float:
        due = self._targets.get(("part", self._own.part_of(name)))
        return 5.0 if due is not None and due == self._other.part_of(other) else 0.0

    def _joints_alike(self, name: str, other: str) -> float:
        one, two = self._own.joint_count(name), self._other.joint_count(other)
        return 0.0 if one is None or two is None or one == two else -5.0

    def _proposed(self, kind: str, name: str, names: Sequence[str]) -> tuple[str, str]:
        """Return the proposal and its reason; no proposal where nothing is like it."""
        best = names[0] if names else ""
        taken = {to for (of, _), to in self._targets.items() if of == kind}
        if not best:
            fits = " that fits" if self._other.all(kind) else ""
            return "", f"{self._other.cell.name} has no {kind if kind in _ORDER else f'{kind} entry'}{fits}"
        if (name.partition("/")[2] or name) == (best.partition("/")[2] or best):
            return best, "same name"
        if kind not in _ORDER:
            return self._entry_proposed(kind, name, names)
        if best in taken and kind in ("robot", "part", "fixture", "frame", "camera", "person"):
            return "", f"no {kind} is left for it"
        if kind == "robot":
            return best, "same tool and joints" if self._robots_alike(name, best) >= 9.0 else "the most like it"
        if len(names) == 1:
            return best, f"the only {kind} that fits"
        if self._score(kind, name, best) >= _ALIKE:
            return best, "the most like it"
        return "", f"no {kind} is like it"

    def _entry_proposed(self, kind: str, name: str, names: Sequence[str]) -> tuple[str, str]:
        """Return the entry that is called after the other robot; another pose is for a person to choose."""
        for (of, robot), target in self._targets.items():
            rest = name.removeprefix(f"{robot}_")
            if of == "robot" and rest != name and f"{target}_{rest}" in names:
                return f"{target}_{rest}", f"that of {target}"
        return "", f"no {kind} entry has this name"


def _is_number(output: str) -> bool:
    return output.partition("/")[2].isdigit()


def _seed(cell: Cell) -> Entries:
    try:
        return load_entries(cell.seed_file).names_by_kind() if cell.seed_file is not None else {}
    except DocumentError:
        return {}  # the check of the cell reports it


def _joint_counts(cell: Cell) -> dict[str, int]:
    try:
        records = load_entries(cell.seed_file).records() if cell.seed_file is not None else ()
    except DocumentError:
        return {}
    found = {each.name: each.value.get("joints") for each in records if each.kind == "joints"}
    return {name: len(cast("list[float]", value)) for name, value in found.items() if isinstance(value, list)}
