"""When work of a run proceeds: tasks, timers, settlement of an instant, holds. Knows no nodes."""
