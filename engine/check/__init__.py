"""The static check: findings about a behavior before it runs, each with node path and file position."""

from engine.check.cell_check import check_cell, check_entries_document
from engine.check.cell_context import CellContext, cell_context
from engine.check.check import check_behavior, check_file, check_given, check_survey, read_beside
from engine.check.drawn_targets import check_targets
from engine.check.finding import CODES, Finding, Severity, invalid, place_of, require_sound
from engine.check.page import page_name, page_text
from engine.check.stored import check_stored, names_by_kind

__all__ = [
    "CODES",
    "CellContext",
    "Finding",
    "Severity",
    "cell_context",
    "check_behavior",
    "check_cell",
    "check_entries_document",
    "check_file",
    "check_given",
    "check_stored",
    "check_survey",
    "check_targets",
    "invalid",
    "names_by_kind",
    "page_name",
    "page_text",
    "place_of",
    "read_beside",
    "require_sound",
]
