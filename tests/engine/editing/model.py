"""What edits mean, on plain data only: written apart from the code under test, and without a thought of text."""

from __future__ import annotations

import copy
from typing import Any, cast

Plain = dict[str, Any]
MACHINES = ("machine", "priority")


def model_of(data: Plain, edit: Plain) -> Plain:
    """Return what a document says after an edit."""
    document = copy.deepcopy(data)
    match edit["edit"]:
        case "rename_node":
            _rename(document, edit["path"], edit["name"])
        case "remove_nodes":
            for path in edit["paths"]:
                _remove(document, path)
        case "set_transition":
            node = _node(document, edit["path"])
            node.setdefault("transitions", {})[edit["outcome"]] = edit["target"]
        case "clear_transition":
            node = _node(document, edit["path"])
            del node["transitions"][edit["outcome"]]
            if not node["transitions"]:
                del node["transitions"]
        case "set_initial":
            _body(_node(document, edit["path"]))["initial"] = edit["child"]
        case "set_parameter":
            node = _node(document, edit["path"])
            if "with" in node:
                node["with"][edit["name"]] = edit["value"]
            else:
                _before(node, "with", {edit["name"]: edit["value"]}, ("description", "name", "state"))
        case "set_field":
            node = _node(document, edit["path"])
            if "description" in node:
                node["description"] = edit["value"]
            else:
                _before(node, "description", edit["value"], ())
        case other:
            raise AssertionError(other)
    return document


def flattened(document: Plain, path: str) -> object:
    """Return a machine with every plain machine in it dissolved: who follows whom among what is left.

    Names of nodes are left out, for grouping may change them: a node is known by what it does.
    """
    states: list[Any] = []
    start = _flat(_node(document, path), {}, states)
    order: dict[int, int] = {}
    due = [start]
    while due:
        target = due.pop(0)
        if isinstance(target, _Step) and id(target) not in order:
            order[id(target)] = len(order)
            due += list(target.leads.values())

    def shown(target: object) -> object:
        return order[id(target)] if isinstance(target, _Step) else target

    reached = [step for step in states if id(step) in order]
    reached.sort(key=lambda step: order[id(step)])
    return shown(start), [(step.does, {how: shown(to) for how, to in step.leads.items()}) for step in reached]


class _Step:
    def __init__(self, does: object) -> None:
        self.does = does
        self.leads: dict[str, Any] = {}


class _Later:
    """A target that is not known yet: the first step of a machine that is being dissolved."""

    def __init__(self) -> None:
        self.is_now: Any = None


def _flat(node: Plain, around: dict[str, Any], states: list[Any]) -> Any:
    kind = next(k for k in MACHINES if k in node)
    inside = node[kind]["states"]
    entries: dict[str, Any] = {name: _Later() for name in inside}
    for name, child in inside.items():
        plain_machine = (
            "machine" in child and not child["machine"].get("userdata") and set(child) <= {"machine", "transitions"}
        )
        wired = {
            how: (entries[to] if to in inside else around.get(to, to))
            for how, to in child.get("transitions", {}).items()
        }
        if plain_machine:
            entries[name].is_now = _flat(child, wired, states)
            continue
        step = _Step(
            {key: value for key, value in child.items() if key not in ("transitions", "timeout", "guard", "on_error")}
        )
        step.leads = wired
        for key in ("timeout", "guard"):
            if key in child:
                to = child[key]["to"]
                step.leads[f"{key} {child[key].get('after')}"] = entries[to] if to in inside else around.get(to, to)
        if "on_error" in child:
            step.leads["on_error"] = (
                entries[child["on_error"]]
                if child["on_error"] in inside
                else around.get(child["on_error"], child["on_error"])
            )
        states.append(step)
        entries[name].is_now = step
    for step in states:
        step.leads = {how: _settled(to) for how, to in step.leads.items()}
    return _settled(entries[node[kind]["initial"]])


def _settled(target: Any) -> Any:
    while isinstance(target, _Later) and target.is_now is not None:
        target = target.is_now
    return target


def _node(document: Plain, path: str) -> Plain:
    node = document["root"]
    for name in path.split("/")[1:]:
        node = dict(_children(node))[name]
    return node


def _children(node: Plain) -> list[tuple[str, Plain]]:
    for kind in ("machine", "priority", "concurrency"):
        if kind in node:
            return list(node[kind]["states"].items())
    if "foreach" in node:
        return [("child", node["foreach"]["child"])]
    if "tree" in node:
        return [(_name(node["tree"]), node["tree"])]
    for kind in ("sequence", "selector", "parallel", "if_then_else", "while_do_else"):
        if kind in node:
            children = node[kind] if isinstance(node[kind], list) else node[kind].get("children", node[kind].values())
            names: list[str] = []
            counts: dict[str, int] = {}
            for child in children:
                base = name = _name(child)
                while name in names:
                    counts[base] = counts.get(base, 1) + 1
                    name = f"{base}_{counts[base]}"
                names.append(name)
            return list(zip(names, children, strict=True))
    for kind in ("inverter", "repeat", "retry", "timeout"):
        if isinstance(node.get(kind), dict) and "child" in node[kind]:
            return [(_name(node[kind]["child"]), node[kind]["child"])]
    return []


def _name(node: Plain) -> str:
    if "name" in node:
        return str(node["name"])
    if "state" in node:
        return str(node["state"]).rsplit(".", 1)[-1]
    return next(
        key
        for key in node
        if key not in ("transitions", "description", "timeout")
        or (isinstance(node[key], dict) and "child" in node[key])
    )


def _body(node: Plain) -> Plain:
    return next(node[kind] for kind in ("machine", "priority", "concurrency") if kind in node)


def _rename(document: Plain, path: str, name: str) -> None:
    parent, _, old = path.rpartition("/")
    container = _node(document, parent)
    body = _body(container)
    body["states"] = {name if key == old else key: each for key, each in body["states"].items()}
    if "concurrency" in container:
        body["conditions"] = [
            {key: _renamed(value, old, name) for key, value in rule.items()} for rule in body["conditions"]
        ]
        return
    if body["initial"] == old:
        body["initial"] = name
    for child in body["states"].values():
        child.update(
            {"transitions": {how: name if to == old else to for how, to in child["transitions"].items()}}
            if "transitions" in child
            else {}
        )
        for key in ("timeout", "guard"):
            if key in child and child[key].get("to") == old:
                child[key]["to"] = name
        if child.get("on_error") == old:
            child["on_error"] = name


def _renamed(value: Any, old: str, name: str) -> Any:
    """Rename a child in a condition, or among those that it preempts."""
    if isinstance(value, list):
        return [name if each == old else each for each in cast("list[str]", value)]
    return {name if key == old else key: due for key, due in value.items()}


def _without(value: Any, old: str) -> Any:
    if isinstance(value, list):
        return [each for each in cast("list[str]", value) if each != old]
    return _of_those_left({key: due for key, due in value.items() if key != old})


def _remove(document: Plain, path: str) -> None:
    parent, _, old = path.rpartition("/")
    container = _node(document, parent)
    body = _body(container)
    del body["states"][old]
    if "concurrency" in container:
        rules = [{key: _without(value, old) for key, value in rule.items()} for rule in body["conditions"]]
        body["conditions"] = [rule for rule in rules if all(rule.values())]
        return
    if body["initial"] == old:
        if body["states"]:
            body["initial"] = next(iter(body["states"]))
        else:
            del body["initial"]
    for child in body["states"].values():
        if "transitions" in child:
            child["transitions"] = {how: to for how, to in child["transitions"].items() if to != old}
            if not child["transitions"]:
                del child["transitions"]


def _of_those_left(when: dict[str, object]) -> dict[str, object]:
    asked = [name for name, due in when.items() if isinstance(due, str)]
    count = when.get("at_least")
    return {name: when[name] for name in asked} if isinstance(count, int) and count > len(asked) else when


def _before(node: Plain, key: str, value: object, after: tuple[str, ...]) -> None:
    """Put a key behind the last of some others, else in front; parameters at the end where nothing is wired."""
    items = list(node.items())
    if key == "with" and "transitions" not in node:
        node[key] = value
        return
    place = max((n + 1 for n, (name, _) in enumerate(items) if name in after), default=0)
    items.insert(place, (key, value))
    node.clear()
    node.update(items)
