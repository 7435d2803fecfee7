# The face of this room for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.sweep_library.baselines import Baseline, SweepComparison
from engine.sweep_library.search_view import SearchView
from engine.sweep_library.shrink_view import Shrinking
from engine.sweep_library.sweep_files import NoSuchSweep
from engine.sweep_library.sweep_requests import (
    CompareSweep,
    CreateSweep,
    FindBaselines,
    ListSweeps,
    OfferFactors,
    ReadRuns,
    ReadSweep,
    ReadTrial,
)
from engine.sweep_library.sweep_service import SweepService
from engine.sweep_library.sweep_view import FactorChoice, RecordedTrial, SweepList, SweepLive, SweepRuns, SweepView

__all__ = [
    "Baseline",
    "CompareSweep",
    "CreateSweep",
    "FactorChoice",
    "FindBaselines",
    "ListSweeps",
    "NoSuchSweep",
    "OfferFactors",
    "ReadRuns",
    "ReadSweep",
    "ReadTrial",
    "RecordedTrial",
    "SearchView",
    "Shrinking",
    "SweepComparison",
    "SweepList",
    "SweepLive",
    "SweepRuns",
    "SweepService",
    "SweepView",
]
