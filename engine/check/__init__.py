"""The static check: findings about a behavior before it runs, each with node path and file position."""

from engine.check.arm_target_checks import check_targets
from engine.check.behavior_check import check_behavior, check_file, check_given, check_survey, read_beside
from engine.check.breakpoint_check import ConditionCheck, check_condition
from engine.check.cell.cell_check import check_cell, check_entries_document
from engine.check.cell.cell_context import CellContext, cell_context
from engine.check.cell.entry_checks import check_stored, names_by_kind
from engine.check.cell.mesh_checks import check_module
from engine.check.cell.parameter_names import parameter_naming
from engine.check.cell.rest_check import check_rest, check_rest_of_items
from engine.check.cell_fit import CellFit, cell_fit
from engine.check.finding import CODES, Finding, Severity, finding_sort_key, invalid_document_finding, require_no_errors
from engine.check.finding_pages import page_name, page_text

__all__ = [
    "CODES",
    "CellContext",
    "CellFit",
    "ConditionCheck",
    "Finding",
    "Severity",
    "cell_context",
    "cell_fit",
    "check_behavior",
    "check_cell",
    "check_condition",
    "check_entries_document",
    "check_file",
    "check_given",
    "check_module",
    "check_rest",
    "check_rest_of_items",
    "check_stored",
    "check_survey",
    "check_targets",
    "finding_sort_key",
    "invalid_document_finding",
    "names_by_kind",
    "page_name",
    "page_text",
    "parameter_naming",
    "read_beside",
    "require_no_errors",
]
