"""A document together with its file, and the position of each of its values in it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Generic, TypeVar

from engine.document.text.yaml_source import DocumentSource

D = TypeVar("D")


@dataclass(frozen=True, kw_only=True)
class DocumentFile(Generic[D]):
    """Base of documents with their file; `source` knows the line and column of each value."""

    document: D
    file: Path
    source: DocumentSource = field(repr=False)
