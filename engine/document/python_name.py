"""Behaviors that Python files make, by their names: `FILE.py` or `FILE.py:NAME`."""

from __future__ import annotations


def is_python_name(name: str) -> bool:
    """Tell whether a name given for a behavior is that of a Python file."""
    return name.endswith(".py") or ".py:" in name
