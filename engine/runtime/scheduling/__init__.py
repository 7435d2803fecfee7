"""Scheduling of a run: tasks, timers, settlement of an instant, holds. Independent of nodes."""
