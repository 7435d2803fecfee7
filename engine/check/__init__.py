"""The static check: findings about a behavior before it runs, each with node path and file position."""

from engine.check.check import check_behavior, check_file, read_beside
from engine.check.finding import CODES, Finding, Severity
from engine.check.page import page_name, page_text

__all__ = ["CODES", "Finding", "Severity", "check_behavior", "check_file", "page_name", "page_text", "read_beside"]
