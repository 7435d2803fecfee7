"""An open cell: its devices and their connection, its store, and the names that behaviors may use."""
