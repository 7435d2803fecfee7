"""Nodes of a plan: states, containers and behavior references, and the execution that they share."""
