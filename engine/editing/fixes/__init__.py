"""Quick fixes: the edits that would resolve a finding, each with a title; a person chooses, nothing is guessed."""

from engine.editing.fixes.fix import Fix
from engine.editing.fixes.fix_registry import fixes_of

__all__ = ["Fix", "fixes_of"]
