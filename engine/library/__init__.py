"""The behaviors of a project folder, loaded and checked, each with its graph."""

from engine.library.behavior_graph import GraphNode, GraphTransition
from engine.library.behavior_library import BehaviorView, FindingView, Library, ParameterView

__all__ = [
    "BehaviorView",
    "FindingView",
    "GraphNode",
    "GraphTransition",
    "Library",
    "ParameterView",
]
