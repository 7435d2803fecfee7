"""Editing of documents: pure edits of their text that preserve every byte they do not concern, and the document files.

`apply_edits` is a function of text and edits; `DocumentRepository` opens, saves, merges and keeps versions.
"""

from engine.editing.adaptation.adaptation import AdaptationPlan, adapt, proposed_file
from engine.editing.adapted_documents import plan_adaptation, write_adaptation
from engine.editing.analysis.data_flow import KeyFlow
from engine.editing.analysis.diagnostics import DocumentAnalysis, analyze_text, text_hash
from engine.editing.analysis.document_diff import DocumentDiff, compare_texts
from engine.editing.analysis.document_graph import DocumentInfo, DocumentNode
from engine.editing.analysis.graph_difference import GraphDifference
from engine.editing.catalogue import BehaviorReferenceView, ContainerView, StateView, container_views, state_views
from engine.editing.cell_references import cell_reference
from engine.editing.document_repository import DocumentRepository
from engine.editing.draft_cache import EditAnswer
from engine.editing.edits.apply import EditRefusal, EditResult, apply_edits, copy_nodes
from engine.editing.edits.edit import AnyEdit
from engine.editing.pictures.pdf import pdf_of
from engine.editing.project_context import ProjectContext
from engine.editing.references import move_with_references, referrers
from engine.editing.referring_behavior import ReferringBehavior
from engine.editing.state_source import StateSource, state_source
from engine.editing.stored_document import DocumentConflict, NoSuchDocument, StoredDocument
from engine.editing.targets.target_checks import TargetChecks
from engine.editing.targets.target_messages import TargetFindings
from engine.editing.text.draft import Draft, EditRefused
from engine.editing.text.node_merge import NodeConflict, NodeMerge, Side
from engine.editing.versions import DocumentVersion

__all__ = [
    "AdaptationPlan",
    "AnyEdit",
    "BehaviorReferenceView",
    "ContainerView",
    "DocumentAnalysis",
    "DocumentConflict",
    "DocumentDiff",
    "DocumentInfo",
    "DocumentNode",
    "DocumentRepository",
    "DocumentVersion",
    "Draft",
    "EditAnswer",
    "EditRefusal",
    "EditRefused",
    "EditResult",
    "GraphDifference",
    "KeyFlow",
    "NoSuchDocument",
    "NodeConflict",
    "NodeMerge",
    "ProjectContext",
    "ReferringBehavior",
    "Side",
    "StateSource",
    "StateView",
    "StoredDocument",
    "TargetChecks",
    "TargetFindings",
    "adapt",
    "analyze_text",
    "apply_edits",
    "cell_reference",
    "compare_texts",
    "container_views",
    "copy_nodes",
    "move_with_references",
    "pdf_of",
    "plan_adaptation",
    "proposed_file",
    "referrers",
    "state_source",
    "state_views",
    "text_hash",
    "write_adaptation",
]
