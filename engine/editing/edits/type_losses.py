"""What a node loses by another type: the fields of its nodes before are compared with those after."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import cast

from engine.editing.edits.edit import TypeLoss
from engine.editing.edits.edit_session import EditSession
from engine.editing.text.draft import EditRefused
from engine.editing.text.outline import NodeRef, Plain, child_entries, kind_of

_LONGEST = 400
_GROUPED = {
    "with": "parameter", "in": "input", "out": "output", "transitions": "transition", "autonomy": "autonomy",
    "retry": "retry", "timeout": "timeout", "guard": "guard", "post": "post",
}  # fmt: skip
"""The keys of which each entry is an item of its own, and what an item is called."""
Fields = Mapping[str, object]
Reasons = dict[tuple[int, str], str]
"""Why a field was removed, by the id of the data of its node."""


class UnacceptedLosses(EditRefused):
    """An edit would remove what it does not accept to lose."""

    def __init__(self, losses: tuple[TypeLoss, ...]) -> None:
        first, more = losses[0], len(losses) - 1
        rest = f" and {more} more" if more else ""
        super().__init__(
            f"the new type does not keep the {first.item} of `{first.path}`{rest}",
            hint="accept what is lost, or choose a type that keeps it",
        )
        self.losses = losses


@dataclass(frozen=True)
class _NodeBefore:
    path: str
    data: Plain
    fields: Fields
    inside: int
    """Number of nodes inside it."""


@dataclass
class LossRecord:
    """The nodes under one as they are before its type changes; `reasons` are added by whoever removes a field."""

    session: EditSession
    ref: NodeRef
    reasons: Reasons = field(default_factory=Reasons)
    _before: list[_NodeBefore] = field(default_factory=list[_NodeBefore])

    def __post_init__(self) -> None:
        refs = self.session.outline.refs.values()
        under = f"{self.ref.path}/"
        for each in refs:
            if each is self.ref or each.path.startswith(under):
                inside = sum(other.path.startswith(f"{each.path}/") for other in refs)
                self._before.append(_NodeBefore(each.path, each.data, _fields(each.data), inside))

    def losses(self, type_name: str) -> Iterator[TypeLoss]:
        """Yield what is no longer there, or has another value; of a node that has gone, only the node."""
        after = {id(ref.data): ref for ref in self.session.outline.refs.values()}
        gone: list[str] = []
        for node in self._before:
            now = after.get(id(node.data))
            if any(node.path.startswith(f"{path}/") for path in gone):
                continue
            if now is None:
                gone.append(node.path)
                value = f"{node.inside} nodes inside" if node.inside else ""
                yield TypeLoss(path=node.path, item="node", value=value, reason=f"it does not fit into {type_name}")
                continue
            kept = _fields(now.data)
            for key, value in node.fields.items():
                if (key in kept and kept[key] == value) or (key == "name" and value == now.name):
                    continue
                reason = self.reasons.get((id(node.data), key)) or f"{type_name} has no such field"
                if key in kept:
                    reason = f"it becomes {_shown(kept[key])}"
                yield TypeLoss(path=node.path, item=_item(key), value=_shown(value), reason=reason)


def _fields(node: Plain) -> Fields:
    """Return the fields of a node by name, without its type and the nodes inside it; `with.speed` is one."""
    kind = kind_of(node, in_tree=True)
    inside = {keys[1] for _, keys, _ in child_entries(node) if len(keys) > 1}
    found: dict[str, object] = {}
    for key, value in node.items():
        if key == kind:
            body = cast("Plain", value) if isinstance(value, dict) and kind != "tree" else {}
            found.update({f"{kind}.{name}": each for name, each in body.items() if name not in inside})
        elif key in _GROUPED and isinstance(value, dict):
            found.update({f"{key}.{name}": each for name, each in cast("Plain", value).items()})
        else:
            found[key] = value
    # Keys of containers are compared by their own name: the key of the kind is what changes.
    return {_plain_key(key, kind): value for key, value in found.items()}


def _plain_key(key: str, kind: str) -> str:
    return key.removeprefix(f"{kind}.") if kind not in _GROUPED else key


def _item(key: str) -> str:
    group, _, name = key.partition(".")
    return f"{_GROUPED[group]} `{name}`" if name and group in _GROUPED else f"field `{key}`"


def _shown(value: object) -> str:
    text = json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
