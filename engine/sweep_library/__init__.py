"""The sweeps of a project for a user interface: found, read, executed and repeated outside of the server's process.

A `SweepService` asks sweep processes (`engine.sweep_library.sweep_process`), whose `SweepReader` reads documents and
results; what they answer are the structs of `engine.sweep_library.sweep_view`, and goes to pages as it is. So the
server itself loads no statistics, checks no document, and keeps no copy of a result.
"""

from engine.lazy_face import lazy_face

_HOMES = {
    "Baseline": "engine.sweep_library.baselines",
    "CompareSweep": "engine.sweep_library.sweep_requests",
    "CreateSweep": "engine.sweep_library.sweep_requests",
    "FactorChoice": "engine.sweep_library.sweep_view",
    "FindBaselines": "engine.sweep_library.sweep_requests",
    "ListSweeps": "engine.sweep_library.sweep_requests",
    "NoSuchSweep": "engine.sweep_library.sweep_files",
    "OfferFactors": "engine.sweep_library.sweep_requests",
    "ReadRuns": "engine.sweep_library.sweep_requests",
    "ReadSweep": "engine.sweep_library.sweep_requests",
    "ReadTrial": "engine.sweep_library.sweep_requests",
    "RecordedTrial": "engine.sweep_library.sweep_view",
    "SearchView": "engine.sweep_library.search_view",
    "Shrinking": "engine.sweep_library.shrink_view",
    "SweepComparison": "engine.sweep_library.baselines",
    "SweepList": "engine.sweep_library.sweep_view",
    "SweepLive": "engine.sweep_library.sweep_view",
    "SweepRuns": "engine.sweep_library.sweep_view",
    "SweepService": "engine.sweep_library.sweep_service",
    "SweepView": "engine.sweep_library.sweep_view",
}

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll] - checkers read `__init__.pyi`
__getattr__ = lazy_face(__name__, _HOMES)
