"""Editing of documents: pure edits of their text that preserve every byte they do not concern, and the document files.

`apply_edits` is a function of text and edits; `DocumentRepository` opens, saves, merges and keeps versions.
"""

from engine.editing.apply import EditRefusal, EditResult, apply_edits, copy_nodes, read_edits
from engine.editing.diagnostics import DocumentAnalysis, analyze_text, text_hash
from engine.editing.document_graph import DocumentInfo, DocumentNode
from engine.editing.document_repository import DocumentConflict, DocumentRepository, NoSuchDocument, StoredDocument
from engine.editing.draft import Draft, EditRefused
from engine.editing.edit import AnyEdit
from engine.editing.project_context import ProjectContext
from engine.editing.three_way_merge import MergeConflict, MergeResult, merge_texts
from engine.editing.versions import DocumentVersion

__all__ = [
    "AnyEdit",
    "DocumentAnalysis",
    "DocumentConflict",
    "DocumentInfo",
    "DocumentNode",
    "DocumentRepository",
    "DocumentVersion",
    "Draft",
    "EditRefusal",
    "EditRefused",
    "EditResult",
    "MergeConflict",
    "MergeResult",
    "NoSuchDocument",
    "ProjectContext",
    "StoredDocument",
    "analyze_text",
    "apply_edits",
    "copy_nodes",
    "merge_texts",
    "read_edits",
    "text_hash",
]
