"""Strongly connected components of a graph: the nodes that lie on common loops."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from typing import TypeVar

T = TypeVar("T", bound=Hashable)


def strong_components(leads: Mapping[T, Sequence[T]]) -> list[list[T]]:
    """Return the strongly connected components in reverse topological order (Tarjan, without recursion)."""
    number: dict[T, int] = {}
    low: dict[T, int] = {}
    stack: list[T] = []
    on_stack: set[T] = set()
    found: list[list[T]] = []
    for root in leads:
        if root in number:
            continue
        due: list[tuple[T, Iterator[T]]] = [(root, iter(leads[root]))]
        number[root] = low[root] = len(number)
        stack.append(root)
        on_stack.add(root)
        while due:
            name, following = due[-1]
            target = next(following, None)
            if target is None:
                due.pop()
                if due:
                    low[due[-1][0]] = min(low[due[-1][0]], low[name])
                if low[name] == number[name]:
                    found.append(_popped(stack, on_stack, name))
            elif target not in number:
                number[target] = low[target] = len(number)
                stack.append(target)
                on_stack.add(target)
                due.append((target, iter(leads[target])))
            elif target in on_stack:
                low[name] = min(low[name], number[target])
    return found


def _popped(stack: list[T], on_stack: set[T], until: T) -> list[T]:
    part: list[T] = []
    while not part or part[-1] != until:
        part.append(stack.pop())
        on_stack.discard(part[-1])
    return part[::-1]
