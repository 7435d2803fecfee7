"""The nodes of a plan: states, containers and references, and the execution that they share."""
