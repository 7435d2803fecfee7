"""Editing of documents: pure edits of their text that keep every byte they are not about, and the files behind them.

`apply_edits` is a function of text and edits; `Documents` opens, saves, merges and keeps versions.
"""

from engine.editing.apply import Edited, Refusal, apply_edits, copy_nodes, read_edits
from engine.editing.documents import DocumentConflict, Documents, NoSuchDocument, Opened
from engine.editing.draft import Draft, EditRefused
from engine.editing.edit import AnyEdit
from engine.editing.examination import Examination, examine, hash_of
from engine.editing.graph import DocumentInfo, DocumentNode
from engine.editing.knowledge import Knowledge
from engine.editing.merging import MergeConflict, Merged, merge_texts
from engine.editing.versions import Version

__all__ = [
    "AnyEdit",
    "DocumentConflict",
    "DocumentInfo",
    "DocumentNode",
    "Documents",
    "Draft",
    "EditRefused",
    "Edited",
    "Examination",
    "Knowledge",
    "MergeConflict",
    "Merged",
    "NoSuchDocument",
    "Opened",
    "Refusal",
    "Version",
    "apply_edits",
    "copy_nodes",
    "examine",
    "hash_of",
    "merge_texts",
    "read_edits",
]
