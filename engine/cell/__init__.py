"""A cell while it is open: its devices and their connection, its store, and the names that it offers to behaviors."""
