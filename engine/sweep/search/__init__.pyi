# The face of this room for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.sweep.search.scripted_search import run_search
from engine.sweep.search.search_execution import SearchEnd, SearchProgress, execute_search, saved_search
from engine.sweep.search.search_reports import search_markdown, search_report
from engine.sweep.search.search_summary import SearchSummary, summarize_search

__all__ = [
    "SearchEnd",
    "SearchProgress",
    "SearchSummary",
    "execute_search",
    "run_search",
    "saved_search",
    "search_markdown",
    "search_report",
    "summarize_search",
]
