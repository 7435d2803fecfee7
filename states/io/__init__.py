"""States that switch digital outputs."""
