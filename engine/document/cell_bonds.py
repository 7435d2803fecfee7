"""Bonds of a cell or module: what joins a part to another part or to a fixture until a force or a blade parts them.

Forces are in newton, torques in newton metres, places in metres.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.cell_bodies import Fixture, Jitter, PartSpec
from engine.document.placement import PositionXyz
from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError
from engine.wording import did_you_mean

BondKind = Literal["clip", "solder", "glue"]
_Force = Annotated[float, Meta(gt=0.0, le=1e5, description="A force in newton")]
_Torque = Annotated[float, Meta(gt=0.0, le=1e5, description="A torque in newton metres")]


class BondSpec(StrictModel, frozen=True, kw_only=True):
    """Joins a part rigidly to another part or to a fixture, where both are placed, until it breaks for good.

    It breaks where more than `force_n` acts on it, or more than `torque_nm` about its place, in simulation for some
    milliseconds. Without a limit it holds whatever acts. A `point` carries no torque: its parts turn about it, as
    about one of several clips. A blade that may cut its kind parts it with `cut_n`; without, none does.
    """

    kind: BondKind
    part: Annotated[str, Meta(min_length=1, description="The part that is joined")]
    to: Annotated[str, Meta(min_length=1, description="The part or fixture that it is joined to")]
    at_m: Annotated[PositionXyz, Meta(description="Its place in the frame of `part`, in metres")] = (0.0, 0.0, 0.0)
    force_n: _Force | None = None
    torque_nm: _Torque | None = None
    point: bool = False
    cut_n: _Force | None = None
    jitter: Annotated[
        float, Meta(ge=0.0, lt=1.0, description="Largest relative deviation of its limits in a seeded run")
    ] = 0.0


def joined_groups(bonds: Mapping[str, BondSpec]) -> tuple[frozenset[str], ...]:
    """Return the parts and fixtures that bonds join to one another, group by group."""
    groups: list[frozenset[str]] = []
    for bond in bonds.values():
        ends = frozenset((bond.part, bond.to))
        touched = [group for group in groups if group & ends]
        groups = [group for group in groups if not group & ends]
        groups.append(ends.union(*touched))
    return tuple(groups)


def require_bonds(
    bonds: Mapping[str, BondSpec],
    source: DocumentSource,
    *,
    parts: Mapping[str, PartSpec],
    fixtures: Mapping[str, Fixture],
) -> None:
    """Require that bonds join what there is, and that what is joined is displaced as one in seeded runs.

    Raises:
        DocumentError: `where` is the position in the document.
    """
    for name, bond in bonds.items():
        for field, message, hint in _problems(bond, parts, {**parts, **fixtures}):
            raise DocumentError(message, where=source.position(("bonds", name, field)), hint=hint)
    for group in joined_groups(bonds):
        for path, message, hint in _jitter_problems(group, parts):
            raise DocumentError(message, where=source.position(path), hint=hint)


def _problems(bond: BondSpec, parts: Collection[str], bodies: Collection[str]) -> Iterator[tuple[str, str, str]]:
    if bond.part not in parts:
        yield "part", f"there is no part `{bond.part}`", did_you_mean(bond.part, parts)
    if bond.to not in bodies:
        yield "to", f"there is no part and no fixture `{bond.to}`", did_you_mean(bond.to, bodies)
    if bond.part == bond.to:
        yield "to", f"`{bond.part}` is joined to itself", "name another part, or a fixture"
    if bond.point and bond.torque_nm is not None:
        yield "torque_nm", "a `point` carries no torque", "remove `torque_nm`, or `point`"


def _jitter_problems(group: frozenset[str], parts: Mapping[str, PartSpec]) -> Iterator[tuple[DataPath, str, str]]:
    fixed = sorted(name for name in group if name not in parts)
    moved = sorted(name for name in group if name in parts and parts[name].jitter != Jitter())
    if moved and fixed:
        message = f"`{moved[0]}` is joined to the fixture `{fixed[0]}` and cannot be displaced"
        yield ("parts", moved[0], "jitter"), message, "remove `jitter`"
    if len(moved) > 1:
        message = f"`{moved[0]}` and `{moved[1]}` are joined and are displaced as one"
        yield ("parts", moved[1], "jitter"), message, f"keep the `jitter` of `{moved[0]}` only"
