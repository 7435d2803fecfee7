"""Records of a run: recorder, tree events, node checkpoints, undo log, and the port to the skill bus."""
