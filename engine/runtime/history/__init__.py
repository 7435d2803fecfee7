"""State of a run derived from its events: its position, and what can be resumed, changed or undone."""
