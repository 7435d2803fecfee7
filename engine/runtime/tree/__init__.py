"""Behavior trees: planned from documents, executed by py_trees, ticked only on demand.

`new_tree` plans one; `Tree` is the work of its node; `TreeRunner` is one activation of it.
"""

from engine.runtime.tree.runner import TreeRunner
from engine.runtime.tree.tree import Tree
from engine.runtime.tree.tree_planning import new_tree

__all__ = ["Tree", "TreeRunner", "new_tree"]
