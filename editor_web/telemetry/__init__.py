"""Subscriptions of a page besides the run: bus metrics, topic messages, plots, userdata and goal progress."""
