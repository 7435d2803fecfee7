"""Begins a project: a folder that runs at once, or the copy of an example."""
