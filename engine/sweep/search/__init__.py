"""Searches for failures: what has ended decides which configurations of a sweep are executed next.

`execute_search` executes what is left of a search, `saved_search` reads it; `summarize_search` and `search_report` tell
what it found: failures and where they are, the nearest successes, and, of cross-entropy, the probability of a failure.
`run_search` does it all, for scripts and notebooks.
"""

from engine.lazy_face import lazy_face

_HOMES = {
    "SearchEnd": "engine.sweep.search.search_execution",
    "SearchProgress": "engine.sweep.search.search_execution",
    "SearchSummary": "engine.sweep.search.search_summary",
    "execute_search": "engine.sweep.search.search_execution",
    "run_search": "engine.sweep.search.scripted_search",
    "saved_search": "engine.sweep.search.search_execution",
    "search_markdown": "engine.sweep.search.search_reports",
    "search_report": "engine.sweep.search.search_reports",
    "summarize_search": "engine.sweep.search.search_summary",
}

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll] - checkers read `__init__.pyi`
__getattr__ = lazy_face(__name__, _HOMES)
