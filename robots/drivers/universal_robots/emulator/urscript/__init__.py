"""URScript: parsed into a tree, and interpreted on an emulated controller, one generator for each thread."""
