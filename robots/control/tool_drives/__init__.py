"""The drives of tools: fingers and tendons, each with one motion at a time."""
