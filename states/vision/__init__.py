"""States that detect objects with the cameras of a cell."""
