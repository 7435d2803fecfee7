"""Checks that what a node reads is defined on every path, and that branches do not get in each other's way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.check.flow.definition_sites import DefinitionSite
from engine.check.flow.key_reads import KeyRead, assignments
from engine.check.flow.userdata_flow import DataFlow
from engine.check.flow.witness_path import format_witness_path, witness_path
from engine.document.node_spec import shared_keys
from engine.suggestions import did_you_mean

_MOST_ROUTES = 100
_SIDE_BY_SIDE = ("concurrency", "parallel")


def check_userdata(subject: AnalyzedBehavior, flow: DataFlow, read: Sequence[KeyRead]) -> Iterator[Finding]:
    """Find keys that are read and not defined, always or on some path, and conflicts between branches."""
    keys = _Keys(subject, flow, read)
    if not subject.incomplete:
        yield from keys.check_defined()
    yield from keys.check_branches()


# No slots: what is worked out for the first finding is kept for the others.
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
        for placed in self.subject.nodes.values():
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
            message = f"`{read.placed.name}` reads `{key}`, which nothing has defined when it is reached"
            hint = f"{where} defines it later, or in a scope of its own; declare it in a `userdata` around both"
            return self.subject.finding("undefined-key", message, path, *read.keys, hint=hint)
        near = did_you_mean(key, self._names)
        if read.by in ("expression", "post"):
            message = f"`{key}` is neither a parameter nor a userdata key that can be read here"
            return self.subject.finding("undeclared-name", message, path, *read.keys, hint=near)
        if read.by == "shared":
            message = f"the shared key `{key}` is defined nowhere around the branches"
            hint = f"give it an initial value in a `userdata`, `{key}: …`; {near}"
            return self.subject.finding("undefined-key", message, path, *read.keys, hint=hint)
        if read.by == "input":
            message = f"`{read.placed.node.state}` reads the userdata key `{key}`, which is not defined here"
            return self.subject.finding("undefined-key", message, path, hint=f"map it with `in: {{{key}: …}}`; {near}")
        message = f"the userdata key `{key}` is not defined here"
        return self.subject.finding("undefined-key", message, path, *read.keys, hint=near)

    def _perhaps_undefined(self, read: KeyRead, *, with_route: bool) -> Finding:
        path, key = read.placed.path, read.key
        message = f"`{read.placed.name}` reads `{key}`, which may not be defined"
        if with_route and read.by not in ("collect", "shared", "post"):
            steps = witness_path(self.flow, path, self.flow.sites.undefined_bit(key))
            message += f": nothing defines it on the way {format_witness_path(steps)}"
        hint = f"give `{key}` an initial value in `userdata`, or lead this way elsewhere"
        return self.subject.finding("maybe-undefined-key", message, path, *read.keys, hint=hint)

    def _places(self, key: str) -> tuple[DefinitionSite, ...]:
        return self.flow.sites.places(key, self.flow.sites.defined_bits(key))

    @cached_property
    def _names(self) -> frozenset[str]:
        """All names that somebody declares or writes anywhere in the behavior."""
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
        """Return the branches that write each key that is defined outside; other keys are lost when they end."""
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
            message = f"{names} run side by side and write `{key}`; what `{writers[-1].name}` writes stays"
            hint = f"let them write different keys with `out`, or name it in the container: `shared: [{key}]`"
            yield self.subject.finding("parallel-writers", message, writers[-1].path, hint=hint)

    def _check_siblings(self, placed: NodeAt, key: str, writers: Sequence[NodeAt]) -> Iterator[Finding]:
        from_outside = self.flow.inside[placed.path] & self.flow.sites.defined_bits(key)
        start = len(placed.path) + 1
        told: set[str] = set()
        for read in self._readers.get(key, ()):
            path = read.placed.path
            if not path.startswith(f"{placed.path}/") or not self.flow.before.get(path, 0) & from_outside:
                continue
            branch = path[start:].partition("/")[0]
            other = next((writer.name for writer in writers if writer.name != branch), None)
            if other is not None and branch not in told:
                told.add(branch)
                message = f"`{read.placed.name}` reads `{key}` as it was before, though `{other}` beside it writes it"
                hint = f"a branch sees what others write once all have ended, or at once with `shared: [{key}]`"
                yield self.subject.finding("sibling-read", message, path, *read.keys, hint=hint)
