"""What a run leaves behind while it proceeds: recorder, marks, checkpoints of nodes, requests to the outside."""
