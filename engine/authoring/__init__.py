"""Behaviors in Python: typed functions that build the same frozen documents as YAML.

    from engine.authoring import Timeout, behavior, machine, parameter, state
    from states.flow.wait import Wait

    pause = parameter("pause", float, default=0.5, unit="s")
    rest = behavior(
        "rest",
        outcomes=["rested"],
        parameters=[pause],
        root=machine(
            initial="wait", states={"wait": state(Wait(duration_s=pause.value), transitions={"done": "rested"})}
        ),
    )

The result is an `engine.document.Behavior`: check it, plan it, run it, write it with `to_yaml`.
"""

from engine.authoring import tree_steps
from engine.authoring.behavior_builder import behavior
from engine.authoring.container_steps import Preempt, concurrency, foreach, machine, priority, tree
from engine.authoring.expression_values import Param, expr
from engine.authoring.leaf_steps import behaviour, reference, state
from engine.authoring.parameter_declaration import parameter
from engine.authoring.python_file import load_python_behavior
from engine.authoring.steps import PartKeys, Step, StepKeys, TreePart
from engine.authoring.tree_steps import *  # noqa: F403 - what it offers is listed there, once
from engine.authoring.yaml_export import is_made_in_python, to_yaml, write_behavior
from engine.document.nodes.node_kind import PostConditionsSpec as Post
from engine.document.nodes.node_spec import GuardSpec as Guard
from engine.document.nodes.node_spec import RetrySpec as Retry
from engine.document.nodes.node_spec import TimeoutSpec as Timeout

__all__ = [
    "Guard",
    "Param",
    "PartKeys",
    "Post",
    "Preempt",
    "Retry",
    "Step",
    "StepKeys",
    "Timeout",
    "TreePart",
    "behavior",
    "behaviour",
    "concurrency",
    "expr",
    "foreach",
    "is_made_in_python",
    "load_python_behavior",
    "machine",
    "parameter",
    "priority",
    "reference",
    "state",
    "to_yaml",
    "tree",
    "write_behavior",
]
__all__ += tree_steps.__all__
