"""Suppresses findings that only follow from unreadable parts of a behavior."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from engine.check.finding import Finding
from engine.document.behavior import Behavior
from engine.document.nodes.node_kind import KINDS, WRAPPERS
from engine.document.nodes.node_spec import TREE_KINDS
from engine.document.partial_behavior import ANY_KEY

_LEADING = ("transitions", "guard", "timeout", "on_error")
_CONTAINING = (*KINDS, *TREE_KINDS, *WRAPPERS)
_HARMLESS = frozenset(("in", "with", "autonomy", "resume", "description", "every", "name", "success"))
"""Keys of a node whose absence changes neither its transitions nor its writes."""
_DECLARING = ("parameters", "userdata")
_OF_COURSE = frozenset(("unreachable-node", "no-path-to-outcome", "instant-loop", "unknown-target", "ambiguous-target"))
_OF_VALUES = frozenset(
    ("type-mismatch", "maybe-type-mismatch", "undefined-key", "maybe-undefined-key", "undeclared-name")
)
_OF_DECLARATIONS = frozenset(
    ("bad-declaration", "required-parameter", "range-too-wide", "missing-unit", "unit-mismatch")
)
_OF_OUTCOMES = frozenset(("unknown-success", "unused-outcome", "unconnected-outcome", "unknown-target"))
_OF_REFERENCES = frozenset(
    ("unknown-parameter", "missing-parameter", "bad-parameter", "unknown-input", "unknown-output", "unknown-outcome")
)


class DocumentGaps:
    """The gaps of one behavior, and the findings that they suppress."""

    def __init__(self, behavior: Behavior) -> None:
        self._of: Mapping[str, frozenset[str]] = behavior.gaps
        self._referred = {
            path
            for path, node in (behavior.nodes() if behavior.references else ())
            if node.behavior is not None and _is_open(behavior.references.get(node.behavior))
        }
        self._around = {path.rpartition("/")[0] for path in self._of if path and self.hides_course(path)}
        nodes = [keys for path, keys in self._of.items() if path]
        self.hides_values = self.hides(*_DECLARING) or any(not keys <= _HARMLESS for keys in nodes)
        """Whether the defined userdata keys are unknown."""
        self._hides_given = any(_has(keys, "with", *_CONTAINING) for keys in nodes)

    def hides(self, *keys: str) -> bool:
        """Return whether one of these keys of the behavior itself is unreadable."""
        return _has(self._of.get("", ()), *keys)

    def hides_course(self, path: str) -> bool:
        """Return whether the transitions of a node are unknown."""
        return _has(self._of.get(path, ()), *_LEADING)

    def hides_ends(self, path: str) -> bool:
        """Return whether the outcomes of a node are unknown."""
        return _has(self._of.get(path, ()), *_CONTAINING) or path in self._referred

    def hides_inside(self, path: str) -> bool:
        """Return whether the transitions of a direct child of a container are unknown."""
        return path in self._around

    def follows(self, finding: Finding, path: str) -> bool:
        """Return whether a finding at the node `path` may only be caused by a gap."""
        code, around = finding.code, path.rpartition("/")[0]
        if path in self._of or (path in self._referred and code in _OF_REFERENCES):
            return True
        if code in _OF_COURSE and around:
            return self.hides_course(around) or self.hides_ends(around) or self.hides_inside(around)
        return (
            (code in _OF_VALUES and self.hides_values)
            or (code in _OF_DECLARATIONS and self.hides("parameters"))
            or (code in _OF_OUTCOMES and path == "root" and self.hides("outcomes", "success"))
            or (code == "shared-resource" and self._hides_given)
        )


def _is_open(referred: Behavior | None) -> bool:
    return referred is not None and bool(referred.gaps.get(""))


def _has(gap: Collection[str], *keys: str) -> bool:
    return bool(gap) and (ANY_KEY in gap or any(key in gap for key in keys))
