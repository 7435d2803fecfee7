"""The mechanics of tools in a simulated world: additions to their specification, and their drives."""
