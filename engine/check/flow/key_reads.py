"""The userdata keys and parameters that the nodes of a behavior read, with their document positions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt, template
from engine.document.expression.cel_expression import Expression
from engine.document.expression.expression import Template, split_text
from engine.document.signature import KeySignature
from engine.errors import ExpressionError

_NO_CONDITIONS: Mapping[tuple[str, ...], Template | ExpressionError] = {}
_NO_ASSIGNMENTS: Mapping[tuple[str, str, str], Template | ExpressionError] = {}

ReadOrigin = Literal["input", "mapped", "expression", "collect", "shared", "post"]


@dataclass(frozen=True, kw_only=True)
class KeyRead:
    """One key that a node reads.

    `input`: the state's input key of the same name. `mapped`: through `in:`. `expression`: a name
    in a `${…}`. `collect`: at the end of a round of a foreach. `shared`: by the branches of a concurrency
    container. `post`: in a `${…}` of a post-condition. `keys` lead to the value in the
    document, from the node inward. A read that is not `required` is skipped without a value.
    """

    placed: NodeAt
    key: str
    by: ReadOrigin
    name: str
    keys: tuple[str | int, ...]
    required: bool = True


def key_reads(subject: AnalyzedBehavior) -> Iterator[KeyRead]:
    """Yield all reads, in document order."""
    for placed in subject.due:
        yield from _inputs(subject, placed)
        for keys, found in expressions(placed):
            for name in sorted(found.names):
                yield KeyRead(placed=placed, key=name, by="expression", name=name, keys=keys)
        for keys, assigned in assignments(placed).items():
            for name in sorted(assigned.names) if isinstance(assigned, Template) else ():
                yield KeyRead(placed=placed, key=name, by="post", name=name, keys=keys)
        if placed.node.foreach is not None:
            for key in placed.node.foreach.collect:
                yield KeyRead(placed=placed, key=key, by="collect", name=key, keys=("foreach", "collect", key))
        if placed.node.concurrency is not None:
            for index, key in enumerate(placed.node.concurrency.shared):
                yield KeyRead(placed=placed, key=key, by="shared", name=key, keys=("concurrency", "shared", index))


def expressions(placed: NodeAt) -> Iterator[tuple[tuple[str | int, ...], Template]]:
    """Yield the values of a node that contain expressions, with the keys that lead to them."""
    for name, found in placed.given.items():
        if isinstance(found, Template) and not found.constant:
            yield ("with", name), found
    for keys, found in conditions(placed).items():
        # Without names the value is constant, which another check reports.
        if isinstance(found, Template) and found.names:
            yield keys, found


def conditions(placed: NodeAt) -> Mapping[tuple[str, ...], Template | ExpressionError]:
    """Return the compiled expressions of guard and foreach of a node, by the keys that lead to them."""
    node = placed.node
    if node.guard is None and node.foreach is None:
        return _NO_CONDITIONS
    found: dict[tuple[str, ...], Template | ExpressionError] = {}
    if node.guard is not None:
        found["guard", "when"] = template(node.guard.when)
    if node.foreach is not None:
        key = "items" if node.foreach.items is not None else "times"
        found["foreach", key] = template(getattr(node.foreach, key))
    return found


def assignments(placed: NodeAt) -> Mapping[tuple[str, str, str], Template | ExpressionError]:
    """Return the compiled values of post-conditions by `post`, event and userdata key, in run order."""
    post = placed.node.post
    if post is None:
        return _NO_ASSIGNMENTS
    sections = (
        ("on_success", post.on_success),
        ("on_failure", post.on_failure),
        ("on_halted", post.on_halted),
        ("always", post.always),
    )
    return {("post", when, key): template(value) for when, assigned in sections for key, value in assigned.items()}


def only_name(found: Template | ExpressionError) -> str | None:
    """Return the name if a value is only one, `${name}`; else None."""
    if not isinstance(found, Template) or found.constant or not isinstance(found.value, str):
        return None
    pieces = split_text(found.value)
    only = pieces[0]
    return only.text if len(pieces) == 1 and isinstance(only, Expression) and only.bare else None


def _inputs(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[KeyRead]:
    node = placed.node
    signature = subject.signature(node)
    declared: Mapping[str, KeySignature] = signature.inputs if signature is not None else {}
    for name, source in node.inputs.items():
        # For a py_trees behaviour a mapped key may be undefined; for other nodes it must be defined.
        required = node.behavior is not None or (name in declared and declared[name].required)
        yield KeyRead(placed=placed, key=source, by="mapped", name=name, keys=("in", name), required=required)
    for name, key in declared.items():
        if name not in node.inputs:
            yield KeyRead(placed=placed, key=name, by="input", name=name, keys=(), required=key.required)
