"""Checks that arm targets of a behavior are reachable and collision-free in the cell document.

Parts are ignored because contact with them is intended; held objects are unknown. Entries have their seed values,
except for those that the behavior itself writes.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from engine.cell.robot_models import robot_models
from engine.check.analyzed_behavior import AnalyzedBehavior, Catalogue, analyze_behaviors
from engine.check.behavior_check import MAX_CHECK_STEPS
from engine.check.cell.cell_context import CellContext, cell_context
from engine.check.cell.entry_references import entries_written
from engine.check.finding import Finding, finding_sort_key, new_finding
from engine.check.state_instances import UNKNOWN_PLACEHOLDER, given_values, try_make_state
from engine.check.values.parameter_checks import default_values
from engine.document.behavior import Behavior
from engine.document.cell import Cell
from engine.document.entries_document import EntriesDocument, NamedAngles
from engine.document.expression.step_meter import METER
from engine.errors import CellError
from engine.messages import Pose
from engine.skills.arm_target import ArmTarget, StaticCell, ToolChange

_CODES = {"unreachable": "unreachable-target", "collision": "target-in-collision"}


@dataclass(frozen=True, kw_only=True)
class _Seeded:
    """The entries of a seed; `written` are those known only in a run, as kind and name."""

    document: EntriesDocument | None
    written: Collection[tuple[str, str]]

    def joints(self, name: str) -> tuple[float, ...] | None:
        """Return an entry of kind `joints`."""
        if self.document is None or ("joints", name) in self.written:
            return None
        found = self.document.joints.get(name)
        return found.joints if isinstance(found, NamedAngles) else found

    def pose(self, name: str) -> Pose | None:
        """Return an entry of kind `pose`."""
        if self.document is None or ("pose", name) in self.written:
            return None
        return self.document.poses.get(name)


@dataclass(frozen=True, kw_only=True)
class _Named:
    """A target, and the node that names it."""

    subject: AnalyzedBehavior
    path: str
    target: ArmTarget


def check_targets(
    behavior: Behavior, catalogue: Catalogue, *, cell: Cell | CellContext | None = None
) -> tuple[Finding, ...]:
    """Return findings for targets that an arm cannot reach or at which it collides, references included.

    Args:
        behavior: The behavior as loaded.
        catalogue: The states by name.
        cell: The cell that it runs in, or its context; by default the cell that it names. Without a cell, the
            result is empty.
    """
    context = cell if isinstance(cell, CellContext) else cell_context(behavior, cell)
    if context.cell is None or (models := robot_models()) is None:
        return ()
    subjects = analyze_behaviors(behavior, catalogue)
    seed = context.seed.document if context.seed is not None else None
    stored = _Seeded(document=seed, written=frozenset(entries_written(subjects)))
    with METER.limited(MAX_CHECK_STEPS, "this check"):
        targets = list(_targets(subjects, stored))
    if not targets:
        return ()
    drawn = models.drawn(context.cell)
    try:
        found = [_finding(each, drawn) for each in targets]
    except CellError as error:
        position = behavior.source.position(("cell",))
        return (new_finding("invalid-cell", f"the cell cannot be built: {error}", path="root", position=position),)
    return tuple(sorted((each for each in found if each is not None), key=finding_sort_key))


def _targets(subjects: tuple[AnalyzedBehavior, ...], stored: _Seeded) -> Iterator[_Named]:
    known = default_values(subjects[0])
    found = [
        (subject, path, each) for subject in subjects for path, each in _declared(subject, subjects, stored, known)
    ]
    # The poses of an arm whose tool frame changes are known only in a run.
    changed = {each.robot for _, _, each in found if isinstance(each, ToolChange)}
    for subject, path, each in found:
        if (
            isinstance(each, ArmTarget)
            and each.robot != UNKNOWN_PLACEHOLDER
            and (each.pose is None or each.robot not in changed)
        ):
            yield _Named(subject=subject, path=path, target=each)


def _declared(
    subject: AnalyzedBehavior, subjects: tuple[AnalyzedBehavior, ...], stored: _Seeded, known: Mapping[str, object]
) -> Iterator[tuple[str, ArmTarget | ToolChange]]:
    # Each reference sets the parameters of a referred behavior: only its constants are known.
    given = known if subject is subjects[0] else dict.fromkeys(subject.behavior.parameters, UNKNOWN_PLACEHOLDER)
    for placed in subject.nodes.values():
        signature = subject.signature(placed.node)
        if signature is None or not signature.has_arm_targets:
            continue
        state = try_make_state(signature, given_values(placed, given))
        if state is None:
            continue
        try:
            yield from [(placed.path, each) for each in state.arm_targets(stored)]
        except Exception:  # noqa: S112 - see below
            # With placeholders for unknown values it may raise anything: its targets are then unknown.
            continue


def _finding(named: _Named, drawn: StaticCell) -> Finding | None:
    target, subject = named.target, named.subject
    fault = drawn.fault(target)
    if fault is None:
        return None
    index = () if target.index is None else (target.index,)
    name = target.parameter if target.index is None else f"{target.parameter}[{target.index}]"
    keys = ("with", target.parameter, *index)
    return subject.finding(_CODES[fault.kind], f"`{name}`: {fault.message}", named.path, *keys, hint=fault.hint)
