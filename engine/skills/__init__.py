"""The standard skills, by which states and robots meet without importing one another."""
