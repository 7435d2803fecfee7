"""The mechanics of tools in a simulated world: what is added to their specification, and what moves them."""
