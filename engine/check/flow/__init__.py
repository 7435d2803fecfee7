"""Data flow: which userdata keys are defined where, and of which kinds their values are, before a run."""
