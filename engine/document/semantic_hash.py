"""Semantic hash of a behavior document: formatting, comments, canvas positions and notes do not count."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping

import msgspec

from engine.document.behavior import BehaviorDocument


def compute_semantic_hash(document: BehaviorDocument, references: Mapping[str, str]) -> str:
    """Return the semantic hash (SHA-256) of a document.

    Args:
        document: The behavior. Its `view` and `notes` are ignored; the order of nodes and parameters is significant.
        references: The hashes of the behaviors it refers to, by the path as written.
    """
    order = [list(document.parameters), *(list(node.children) for _, node in document.root.nodes_as_root)]
    digest = hashlib.sha256()
    for part in (msgspec.structs.replace(document, view={}, notes={}), order, references):
        digest.update(msgspec.json.encode(part, order="sorted"))
        digest.update(b"\n")
    return digest.hexdigest()
