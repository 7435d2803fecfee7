"""How long tests wait for what must happen: they only keep a test from hanging, and a busy machine takes its time."""

GUARD_S = 60.0
GUARD_MS = 1000 * GUARD_S
"""The same for a page, where what is expected is far behind what was done: a whole run, a first picture."""
