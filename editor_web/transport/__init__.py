"""Connections below HTTP: accepting, time and size limits, capacity, log throttling. Imports no other package."""
