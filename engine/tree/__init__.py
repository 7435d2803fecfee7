"""Behavior trees: planned from documents, executed by py_trees, ticked only when something woke them.

`new_tree` plans one; `Tree` is the work of its node; `TreeRunner` is one activation of it.
"""

from engine.tree.planning import new_tree
from engine.tree.runner import TreeRunner
from engine.tree.tree import Tree

__all__ = ["Tree", "TreeRunner", "new_tree"]
