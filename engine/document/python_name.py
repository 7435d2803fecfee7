"""Names of behaviors built in Python files: `FILE.py` or `FILE.py:NAME`."""

from __future__ import annotations


def is_python_name(name: str) -> bool:
    """Return whether the name of a behavior refers to a Python file."""
    return name.endswith(".py") or ".py:" in name
