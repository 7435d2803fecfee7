"""The drives of tools: fingers, tendons and magnets, each with one motion at a time."""
