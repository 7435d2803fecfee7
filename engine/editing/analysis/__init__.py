"""What a text under edit says: its graph, its findings, the flow of its data, its difference from another."""
