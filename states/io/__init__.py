"""States that switch inputs and outputs."""
