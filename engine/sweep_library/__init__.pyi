# The face of this room for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.sweep_library.sweep_files import NoSuchSweep
from engine.sweep_library.sweep_requests import CreateSweep, ListSweeps, OfferFactors, ReadRuns, ReadSweep, ReadTrial
from engine.sweep_library.sweep_service import SweepService
from engine.sweep_library.sweep_view import FactorChoice, RecordedTrial, SweepList, SweepLive, SweepRuns, SweepView

__all__ = [
    "CreateSweep",
    "FactorChoice",
    "ListSweeps",
    "NoSuchSweep",
    "OfferFactors",
    "ReadRuns",
    "ReadSweep",
    "ReadTrial",
    "RecordedTrial",
    "SweepList",
    "SweepLive",
    "SweepRuns",
    "SweepService",
    "SweepView",
]
