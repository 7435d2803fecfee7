"""Checks that the keys a node reads are defined on every path, and that branches do not conflict."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.disabled_nodes import disabled_writer
from engine.check.finding import Finding
from engine.check.flow.definition_sites import DefinitionSite
from engine.check.flow.key_reads import KeyRead, assignments
from engine.check.flow.userdata_flow import DataFlow
from engine.check.flow.witness_path import format_witness_path, witness_path
from engine.document.nodes.node_spec import shared_keys
from engine.wording.suggestions import did_you_mean

_MOST_ROUTES = 100
_SIDE_BY_SIDE = ("concurrency", "parallel")


def check_userdata(subject: AnalyzedBehavior, flow: DataFlow, read: Sequence[KeyRead]) -> Iterator[Finding]:
    """Find keys that are read but undefined, always or on some path, and conflicts between branches."""
    keys = _Keys(subject, flow, read)
    if not subject.incomplete:
        yield from keys.check_defined()
    yield from keys.check_branches()


# No slots: cached properties need a `__dict__`.
@dataclass(frozen=True)
class _Keys:
    subject: AnalyzedBehavior
    flow: DataFlow
    read: Sequence[KeyRead]

    def check_defined(self) -> Iterator[Finding]:
        sites = self.flow.sites
        routes = 0
        for read in self.read:
            fact = self.flow.fact_at(read) or 0
            if not fact & sites.undefined_bit(read.key):
                continue
            if not fact & sites.defined_bits(read.key):
                if read.required or (read.by == "mapped" and not self._places(read.key)):
                    yield self._undefined(read)
            elif read.required:
                routes += 1
                yield self._perhaps_undefined(read, with_route=routes <= _MOST_ROUTES)

    def check_branches(self) -> Iterator[Finding]:
        for placed in self.subject.due:
            if placed.kind in _SIDE_BY_SIDE and placed.path in self.flow.inside:
                writers = self._writers(placed)
                for key in sorted(writers.keys() - set(shared_keys(placed.node))):
                    yield from self._check_writers(key, writers[key])
                    yield from self._check_siblings(placed, key, writers[key])

    def _undefined(self, read: KeyRead) -> Finding:
        path, key = read.placed.path, read.key
        places = self._places(key)
        if places:
            where = " and ".join(f"`{place.path}`" for place in places[:3])
            message = f"`{read.placed.name}` reads `{key}`, which is not defined at this point"
            hint = f"{where} defines it later, or in its own scope; declare it in a `userdata` around both"
            return self.subject.finding("undefined-key", message, path, *read.keys, hint=hint)
        writer = disabled_writer(self.subject, key)
        if writer is not None:
            message = f"`{read.placed.name}` reads `{key}`, which only the disabled node `{writer}` writes"
            hint = f"enable it, disable `{read.placed.name}` too, or declare `{key}` in `userdata`"
            return self.subject.finding("undefined-key", message, path, *read.keys, hint=hint)
        suggestion = did_you_mean(key, self._names)
        if read.by in ("expression", "post"):
            message = f"`{key}` is neither a parameter nor a userdata key that can be read here"
            return self.subject.finding("undeclared-name", message, path, *read.keys, hint=suggestion)
        if read.by == "shared":
            message = f"the shared key `{key}` is not defined around the branches"
            hint = f"add an initial value to a `userdata`, `{key}: …`; {suggestion}"
            return self.subject.finding("undefined-key", message, path, *read.keys, hint=hint)
        if read.by == "input":
            message = f"`{read.placed.node.state}` reads the userdata key `{key}`, which is not defined here"
            return self.subject.finding(
                "undefined-key", message, path, hint=f"map it with `in: {{{key}: …}}`; {suggestion}"
            )
        message = f"the userdata key `{key}` is not defined here"
        return self.subject.finding("undefined-key", message, path, *read.keys, hint=suggestion)

    def _perhaps_undefined(self, read: KeyRead, *, with_route: bool) -> Finding:
        path, key = read.placed.path, read.key
        message = f"`{read.placed.name}` reads `{key}`, which may be undefined"
        if with_route and read.by not in ("collect", "shared", "post"):
            steps = witness_path(self.flow, path, self.flow.sites.undefined_bit(key))
            message += f": it is not defined on the path {format_witness_path(steps)}"
        hint = f"add an initial value of `{key}` to `userdata`, or change this path"
        return self.subject.finding("maybe-undefined-key", message, path, *read.keys, hint=hint)

    def _places(self, key: str) -> tuple[DefinitionSite, ...]:
        return self.flow.sites.places(key, self.flow.sites.defined_bits(key))

    @cached_property
    def _names(self) -> frozenset[str]:
        """All names that are declared or written anywhere in the behavior."""
        document = self.subject.behavior.document
        names = {*document.parameters, *document.userdata}
        for placed in self.subject.nodes.values():
            node = placed.node
            names |= {*node.userdata, *node.outputs.values(), *(key for _, _, key in assignments(placed))}
            signature = self.subject.signature(node)
            if signature is not None:
                names |= {key for key in signature.outputs if key not in node.outputs}
            if node.foreach is not None:
                names |= {node.foreach.item, *node.foreach.collect.values()}
                names |= {node.foreach.index} if node.foreach.index else set()
        return frozenset(names)

    @cached_property
    def _readers(self) -> Mapping[str, Sequence[KeyRead]]:
        found: dict[str, list[KeyRead]] = {}
        for read in self.read:
            found.setdefault(read.key, []).append(read)
        return found

    def _writers(self, placed: NodeAt) -> dict[str, list[NodeAt]]:
        """Return the branches that write each key defined outside; other keys are discarded when they end."""
        sites = self.flow.sites
        writers: dict[str, list[NodeAt]] = {}
        for child in self.subject.children(placed):
            for key in self.flow.anywhere[child.path].keys:
                if self.flow.inside[placed.path] & sites.defined_bits(key):
                    writers.setdefault(key, []).append(child)
        return writers

    def _check_writers(self, key: str, writers: Sequence[NodeAt]) -> Iterator[Finding]:
        if len(writers) > 1:
            names = " and ".join(f"`{child.name}`" for child in writers)
            message = f"{names} run concurrently and write `{key}`; the value of `{writers[-1].name}` remains"
            hint = f"let them write different keys with `out`, or name it in the container: `shared: [{key}]`"
            yield self.subject.finding("parallel-writers", message, writers[-1].path, hint=hint)

    def _check_siblings(self, placed: NodeAt, key: str, writers: Sequence[NodeAt]) -> Iterator[Finding]:
        from_outside = self.flow.inside[placed.path] & self.flow.sites.defined_bits(key)
        start = len(placed.path) + 1
        reported: set[str] = set()
        for read in self._readers.get(key, ()):
            path = read.placed.path
            if not path.startswith(f"{placed.path}/") or not self.flow.before.get(path, 0) & from_outside:
                continue
            branch = path[start:].partition("/")[0]
            other = next((writer.name for writer in writers if writer.name != branch), None)
            if other is not None and branch not in reported:
                reported.add(branch)
                message = (
                    f"`{read.placed.name}` reads the previous value of `{key}`, which `{other}` writes concurrently"
                )
                hint = f"branches see each other's values when all have ended, or immediately with `shared: [{key}]`"
                yield self.subject.finding("sibling-read", message, path, *read.keys, hint=hint)
