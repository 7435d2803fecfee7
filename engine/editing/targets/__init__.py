"""The check of motion targets, in a process of its own: it loads models of robots."""
