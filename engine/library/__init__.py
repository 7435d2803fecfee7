"""The behaviors of a project folder, loaded and checked, each with its graph."""

from engine.library.behavior_graph import GraphNode, GraphTransition
from engine.library.behavior_library import BehaviorView, FindingView, Library, ParameterView
from engine.library.name_search import NameHit, NameKind, behavior_names, search_names

__all__ = [
    "BehaviorView",
    "FindingView",
    "GraphNode",
    "GraphTransition",
    "Library",
    "NameHit",
    "NameKind",
    "ParameterView",
    "behavior_names",
    "search_names",
]
