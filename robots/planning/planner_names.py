"""The names of the motion planners, which can be told without loading any."""

from __future__ import annotations

FAST, STOMP = "fast", "stomp"

OMPL_PLANNERS = (
    "RRTConnect",
    "RRT",
    "RRTstar",
    "InformedRRTstar",
    "PRM",
    "PRMstar",
    "KPIECE1",
    "BKPIECE1",
    "LBKPIECE1",
    "BITstar",
)
"""Planners of OMPL that its Python package offers and that can be told to stop at the first way."""

UNAVAILABLE_PLANNERS = ("SBL", "EST", "BIEST", "TRRT", "BITRRT", "STRIDE", "PDST", "LAZYPRM")
"""Planners of OMPL that its Python package does not offer, in capitals."""

PLANNERS = (FAST, STOMP, *OMPL_PLANNERS)
"""All planners by name."""
