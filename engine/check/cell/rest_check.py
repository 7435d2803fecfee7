"""Checks that the bodies of a cell do not touch before anything has moved: a warning at both, where they stand."""

from __future__ import annotations

from collections.abc import Iterator

from engine.cell.rest_contacts import RestContact
from engine.cell.robot_models import robot_models
from engine.check.finding import Finding, finding_sort_key, new_finding
from engine.document.cell import Cell
from engine.document.text.yaml_source import DataPath
from engine.errors import FlexcellError


def check_rest(cell: Cell) -> tuple[Finding, ...]:
    """Return a finding for each pair of bodies that touch, or that an arm is too near to, at the first of them.

    A cell whose scene cannot be built has none: another check says why.
    """
    return tuple(sorted((pair[0] for pair in _found(cell)), key=finding_sort_key))


def check_rest_of_items(cell: Cell) -> tuple[Finding, ...]:
    """Return the findings of `check_rest` at both items of each pair; `path` is that of the item: `robots/left`."""
    return tuple(finding for pair in _found(cell) for finding in pair)


def _found(cell: Cell) -> Iterator[tuple[Finding, ...]]:
    models = robot_models()
    if models is None or not (cell.document.robots or cell.document.parts or cell.modules):
        return
    try:
        contacts = models.rest_contacts(cell)
    except FlexcellError:
        return
    for contact in contacts:
        arms = [cell.document.robots.get(body.partition("/")[0]) for body in (contact.first, contact.second)]
        hint = "move one of them, or give the arm another home" if any(arms) else "move one of them"
        items = dict.fromkeys(item for item in (_item(cell, contact.first), _item(cell, contact.second)) if item)
        yield tuple(
            new_finding(
                "collision-at-rest",
                _message(contact),
                path="/".join(str(step) for step in item),
                position=cell.source.position(item, of_key=True),
                hint=hint,
            )
            for item in items
        )


def _message(contact: RestContact) -> str:
    mm = 1e3 * abs(contact.distance_m)
    how = f"overlap by {mm:.1f} mm" if contact.distance_m <= 0.0 else f"are {mm:.1f} mm apart"
    return f"`{contact.first}` and `{contact.second}` {how} while everything is at rest"


def _item(cell: Cell, body: str) -> DataPath | None:
    """Return the place in the document of the item that a body belongs to."""
    document = cell.document
    for section, items in (
        ("parts", document.parts),
        ("fixtures", document.fixtures),
        ("unknown_bodies", document.unknown_bodies),
    ):
        if body in items:
            return section, body
    robot = body.partition("/")[0]
    return ("robots", robot) if robot in document.robots else None
