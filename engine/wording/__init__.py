"""What is said of a name or value that does not fit, and of what would fit instead."""
