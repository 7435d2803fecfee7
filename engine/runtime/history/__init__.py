"""What the events of a run say about it: where it stands, what can be resumed, changed or undone."""
