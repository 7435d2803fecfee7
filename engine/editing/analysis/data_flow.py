"""Writers and readers of each userdata key of a behavior, and paths on which a reader finds it undefined."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from engine.check.analyzed_behavior import AnalyzedBehavior, Catalogue, NodeAt, analyze_behaviors
from engine.check.flow.definition_sites import DefinitionSites
from engine.check.flow.key_reads import KeyRead, assignments, key_reads
from engine.check.flow.userdata_flow import DataFlow
from engine.check.flow.witness_path import format_witness_path, witness_path
from engine.document.behavior import Behavior

KeyOrigin = Literal["parameter", "userdata", "item", "index", "output", "collect", "post"]
Definedness = Literal["always", "maybe", "never", "unreachable"]
_MOST_ROUTES = 200


@dataclass(frozen=True, kw_only=True)
class KeyWriter:
    """A node that writes a key, or a container that declares it; the path is empty for the document itself.

    `name` is the output key, or the field of the node that writes it.
    """

    path: str
    origin: KeyOrigin
    name: str


@dataclass(frozen=True, kw_only=True)
class KeyReader:
    """A node that reads a key.

    `by`: as an input of the same name, mapped through `in`, in an expression, or collected by a foreach. `sources` are
    the paths from which the value may come, `defined` whether there is one; `witness` is how it is reached without one.
    """

    path: str
    by: str
    name: str
    required: bool
    defined: Definedness
    sources: tuple[str, ...]
    witness: str = ""


@dataclass(frozen=True, kw_only=True)
class KeyFlow:
    """One key with all its writers and readers, in document order."""

    key: str
    writers: tuple[KeyWriter, ...]
    readers: tuple[KeyReader, ...]


def data_flow(behavior: Behavior, catalogue: Catalogue) -> tuple[KeyFlow, ...]:
    """Return the keys of a behavior, declared keys first; referenced behaviors are not entered."""
    subject = analyze_behaviors(behavior, catalogue)[0]
    written = list(_writers(subject))
    read = tuple(key_reads(subject))
    keys = dict.fromkeys((*(key for key, _ in written), *(each.key for each in read)))
    flow = DataFlow(subject, DefinitionSites(keys))
    readers = [(each.key, _reader(flow, each, with_witness=number < _MOST_ROUTES)) for number, each in enumerate(read)]
    return tuple(
        KeyFlow(
            key=key,
            writers=tuple(writer for of, writer in written if of == key),
            readers=tuple(reader for of, reader in readers if of == key),
        )
        for key in keys
    )


def _writers(subject: AnalyzedBehavior) -> Iterator[tuple[str, KeyWriter]]:
    document = subject.behavior.document
    for key in document.parameters:
        yield key, KeyWriter(path="", origin="parameter", name=key)
    for key in document.userdata:
        yield key, KeyWriter(path="", origin="userdata", name=key)
    for placed in subject.nodes.values():
        yield from _written(subject, placed)


def _written(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[tuple[str, KeyWriter]]:
    node, path = placed.node, placed.path
    for key in node.userdata:
        yield key, KeyWriter(path=path, origin="userdata", name=key)
    rounds = node.foreach
    if rounds is not None:
        yield rounds.item, KeyWriter(path=path, origin="item", name="as")
        if rounds.index is not None:
            yield rounds.index, KeyWriter(path=path, origin="index", name="index")
        for inner, outer in rounds.collect.items():
            yield outer, KeyWriter(path=path, origin="collect", name=inner)
    for _, when, key in assignments(placed):
        yield key, KeyWriter(path=path, origin="post", name=when)
    signature = subject.signature(node)
    for name in signature.outputs if signature is not None else ():
        if name not in node.outputs:
            yield name, KeyWriter(path=path, origin="output", name=name)
    for name, key in node.outputs.items():
        yield key, KeyWriter(path=path, origin="output", name=name)


def _reader(flow: DataFlow, read: KeyRead, *, with_witness: bool) -> KeyReader:
    path, sites = read.placed.path, flow.sites
    fact = flow.fact_at(read)
    defined: Definedness = "unreachable"
    sources: tuple[str, ...] = ()
    witness = ""
    if fact is not None:
        undefined, known = fact & sites.undefined_bit(read.key), fact & sites.defined_bits(read.key)
        defined = "always" if not undefined else "maybe" if known else "never"
        sources = tuple(site.path for site in sites.places(read.key, known))
        if undefined and known and with_witness and read.by not in ("collect", "shared", "post"):
            witness = format_witness_path(witness_path(flow, path, sites.undefined_bit(read.key)))
    return KeyReader(
        path=path, by=read.by, name=read.name, required=read.required, defined=defined, sources=sources, witness=witness
    )
