"""The names of the motion planners, available without loading any planner."""

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
"""OMPL planners that its Python package provides and that can stop at the first path."""

UNAVAILABLE_PLANNERS = ("SBL", "EST", "BIEST", "TRRT", "BITRRT", "STRIDE", "PDST", "LAZYPRM")
"""OMPL planners that its Python package does not provide, in capitals."""

PLANNERS = (FAST, STOMP, *OMPL_PLANNERS)
"""All planners by name."""
