"""The behaviors of a project folder, loaded and checked, each with its graph."""

from engine.library.behavior_graph import GraphNode, GraphTransition
from engine.library.behavior_library import BehaviorView, FindingView, Library, ParameterView
from engine.library.name_search import NameHit, NameKind, behavior_names, search_names
from engine.library.usages import Usage, Usages, UsedKind, find_usages

__all__ = [
    "BehaviorView",
    "FindingView",
    "GraphNode",
    "GraphTransition",
    "Library",
    "NameHit",
    "NameKind",
    "ParameterView",
    "Usage",
    "Usages",
    "UsedKind",
    "behavior_names",
    "find_usages",
    "search_names",
]
