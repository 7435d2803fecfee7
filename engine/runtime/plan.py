"""Executable form of a behavior: names resolved, expressions compiled, node paths assigned."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from engine.document import behavior as document
from engine.document.expression.expression import Template, compile_template
from engine.document.nodes import node_spec as nodes
from engine.document.parameter_spec import ParameterSpec, bind_parameters
from engine.document.signature import read_signature
from engine.document.state_catalogue import Catalogue, find_state
from engine.document.substitutes import Substitutes
from engine.errors import DocumentError, ExpressionError, RegistryError
from engine.runtime.nodes import concurrency, machine
from engine.runtime.nodes.behavior_reference import BehaviorReference
from engine.runtime.nodes.disabled_work import DisabledWork
from engine.runtime.nodes.foreach import ForEach
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.nodes.node import Node, NodeWork
from engine.runtime.nodes.node_policies import GuardPolicy, RetryPolicy, TimeoutPolicy
from engine.runtime.nodes.priority import Priority
from engine.runtime.nodes.substitute_work import SUBSTITUTE, require_used, substitute_for
from engine.runtime.userdata.userdata_value import plain_value
from engine.state import State
from engine.wording.suggestions import did_you_mean

__all__ = ["Catalogue", "Plan", "new_plan"]


@dataclass(frozen=True, kw_only=True)
class Plan:
    """The executable plan of a behavior; immutable, so any number of runs may share it."""

    name: str
    document_hash: str
    root: Node
    outcomes: tuple[str, ...]
    success: tuple[str, ...]
    parameters: Mapping[str, ParameterSpec]
    userdata: Mapping[str, object]
    substitutes: Substitutes | None = None
    source: document.Behavior | None = field(default=None, repr=False, compare=False)
    """The behavior that the plan was built from; None for a referenced behavior inside another."""

    @cached_property
    def nodes(self) -> Mapping[str, Node]:
        """All nodes by path, in document order, including those of referenced behaviors."""
        nodes_by_path: dict[str, Node] = {}
        due = [self.root]
        while due:
            node = due.pop()
            nodes_by_path[node.path] = node
            due += reversed(list(node.work.children.values()))
        return nodes_by_path

    @cached_property
    def commands_hardware(self) -> bool:
        """Whether any of its states commands a device."""
        return any(isinstance(node.work, Leaf) and node.work.commands_hardware for node in self.nodes.values())

    @cached_property
    def stood_in_for(self) -> tuple[str, ...]:
        """The nodes that are replaced by substitutes, in document order."""
        return tuple(path for path, node in self.nodes.items() if node.work.kind == SUBSTITUTE)

    def outcomes_of(self, path: str) -> tuple[str, ...] | None:
        """Return the possible outcomes of the node at `path`; None where there is no such node."""
        node = self.nodes.get(path)
        return node.work.outcomes if node is not None else None

    def checked_parameters(self, given: Mapping[str, object]) -> dict[str, object]:
        """Return a value for every parameter.

        Raises:
            DocumentError: a parameter is unknown, missing or invalid.
        """
        return bind_parameters(self.parameters, given, where=self.name)

    def checked_inputs(self, given: Mapping[str, object]) -> dict[str, object]:
        """Return the initial userdata values given for a run.

        Raises:
            DocumentError: the behavior does not declare such a key.
            UserdataError: a value cannot be stored without change.
        """
        for key in given:
            if key not in self.userdata:
                raise DocumentError(
                    f"there is no userdata key {key!r}", where=self.name, hint=did_you_mean(key, self.userdata)
                )
            plain_value(given[key], key=key, where=self.name)
        return dict(given)


def new_plan(behavior: document.Behavior, catalogue: Catalogue) -> Plan:
    """Build the plan of a behavior, with its substitutes.

    Raises:
        DocumentError: a state is unknown, an expression does not compile, or a substitute matches no node; `where` is
            the position.
    """
    plan = _new_plan(behavior, catalogue, path="root", substitutes=behavior.substitutes)
    if behavior.substitutes is not None:
        require_used(behavior.substitutes, plan.nodes)
    return replace(plan, source=behavior)


def _new_plan(behavior: document.Behavior, catalogue: Catalogue, *, path: str, substitutes: Substitutes | None) -> Plan:
    """Plan a behavior whose root has the path `path`."""
    return Plan(
        name=behavior.name,
        document_hash=behavior.meaning,
        root=_Planner(behavior, catalogue, path, substitutes).node("root", "root", behavior.root),
        outcomes=behavior.outcomes,
        success=behavior.success,
        parameters=behavior.parameters,
        userdata=behavior.document.userdata,
        substitutes=substitutes,
    )


@dataclass(frozen=True)
class _Planner:
    behavior: document.Behavior
    catalogue: Catalogue
    base: str
    substitutes: Substitutes | None

    def node(self, name: str, inside: str, node: nodes.NodeSpec) -> Node:
        """Plan one node; `inside` is its path in its own document."""
        makers: dict[str, Callable[[str, nodes.NodeSpec], NodeWork]] = {
            "state": self._leaf,
            "machine": self._machine,
            "concurrency": self._concurrency,
            "priority": self._priority,
            "foreach": self._foreach,
            "tree": self._tree,
            "behavior": self._reference,
        }
        if node.kind not in makers:
            where = self.behavior.position(inside)
            raise DocumentError(f"`{node.kind}` cannot be run yet", where=where, hint="use a machine")
        path = self.base + inside.removeprefix("root")
        if node.is_disabled:
            return self._disabled(path, name, inside, node)
        work = makers[node.kind](inside, node)
        return Node(
            path=path,
            name=name,
            work=work if self.substitutes is None else substitute_for(path, work, self.substitutes, self.catalogue),
            transitions=node.transitions,
            timeout=_timeout(node.timeout),
            retry=_retry(node.retry) if node.retry else None,
            on_error=node.on_error,
            guard=self._guard(inside, node.guard),
            autonomy=node.autonomy,
            resume=node.resume,
            position=str(self.behavior.position(inside)),
        )

    def _disabled(self, path: str, name: str, inside: str, node: nodes.NodeSpec) -> Node:
        """Plan a node that is passed over: of its policies and of what is inside nothing applies."""
        outcome = node.passes_with
        return Node(
            path=path,
            name=name,
            work=DisabledWork(outcome=outcome),
            transitions={outcome: node.transitions[outcome]} if outcome in node.transitions else {},
            position=str(self.behavior.position(inside)),
            disabled=outcome,
        )

    def _guard(self, inside: str, guard: nodes.GuardSpec | None) -> GuardPolicy | None:
        if guard is None or guard.to is None:
            return None
        return GuardPolicy(when=self._template(inside, guard.when, "guard", "when"), target=guard.to)

    def _template(self, inside: str, value: object, *keys: str) -> Template:
        try:
            return compile_template(value)
        except ExpressionError as error:
            where = self.behavior.position(inside, *keys)
            raise DocumentError(error.message, where=where, hint=error.hint) from None

    def _children(self, inside: str, node: nodes.NodeSpec) -> dict[str, Node]:
        return {name: self.node(name, f"{inside}/{name}", child) for name, child in node.children.items()}

    def _machine(self, inside: str, node: nodes.NodeSpec) -> machine.Machine:
        states = node.sequential
        return machine.Machine(
            initial=states.initial if states else "",
            children=self._children(inside, node),
            userdata=node.userdata,
            kind=node.kind,
        )

    def _priority(self, inside: str, node: nodes.NodeSpec) -> NodeWork:
        return Priority(machine=self._machine(inside, node))

    def _foreach(self, inside: str, node: nodes.NodeSpec) -> NodeWork:
        rounds = node.foreach
        if rounds is None:
            raise DocumentError("this foreach has no keys", where=self.behavior.position(inside))
        child = self._children(inside, node)["child"]
        return ForEach(
            child=child,
            items=self._template(inside, rounds.items if rounds.items is not None else rounds.times, "foreach"),
            counted=rounds.items is None,
            item=rounds.item,
            index=rounds.index,
            next=frozenset(rounds.next) or child.work.nominal,
            collect=rounds.collect,
            userdata=rounds.userdata,
            position=str(self.behavior.position(inside)),
        )

    def _tree(self, inside: str, node: nodes.NodeSpec) -> NodeWork:
        # Imported with the first tree: py_trees takes as long to import as half of the rest of the engine.
        from engine.runtime.tree import new_tree

        return new_tree(inside, node, base=self.base, behavior=self.behavior, catalogue=self.catalogue, plan=self.node)

    def _concurrency(self, inside: str, node: nodes.NodeSpec) -> NodeWork:
        container = node.concurrency
        return concurrency.Concurrency(
            children=self._children(inside, node),
            conditions=container.rules if container else (),
            otherwise=container.otherwise if container else None,
            userdata=node.userdata,
            shared=frozenset(container.shared) if container else frozenset(),
        )

    def _leaf(self, inside: str, node: nodes.NodeSpec) -> NodeWork:
        state = self._state(inside, node.state or "")
        return Leaf(
            state=state,
            signature=read_signature(state),
            parameters=self._template(inside, node.parameters, "with"),
            inputs=node.inputs,
            outputs=node.outputs,
            autonomy=node.autonomy,
            position=str(self.behavior.position(inside)),
        )

    def _state(self, inside: str, name: str) -> type[State]:
        try:
            return find_state(self.catalogue, name, self.behavior.classes)
        except RegistryError as error:
            raise DocumentError(
                error.message, where=self.behavior.position(inside, "state"), hint=error.hint
            ) from error

    def _reference(self, inside: str, node: nodes.NodeSpec) -> NodeWork:
        target = self.behavior.references[node.behavior or ""]
        below = self.base + inside.removeprefix("root")
        return BehaviorReference(
            target=_new_plan(target, self.catalogue, path=f"{below}/root", substitutes=self.substitutes),
            parameters=self._template(inside, node.parameters, "with"),
            inputs=node.inputs,
            outputs=node.outputs,
            position=str(self.behavior.position(inside)),
        )


def _timeout(timeout: nodes.TimeoutSpec | None) -> TimeoutPolicy | None:
    if timeout is None or timeout.to is None:
        return None
    return TimeoutPolicy(after_s=timeout.after_s, target=timeout.to)


def _retry(retry: nodes.RetrySpec) -> RetryPolicy:
    return RetryPolicy(times=retry.times, backoff_s=retry.backoff_s, outcomes=retry.outcomes, errors=retry.errors)
