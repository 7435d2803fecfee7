"""Behaviors, cells and entries: data that ships with flexcell."""
