"""Data flow: where userdata keys are defined, and the types of their values, before a run."""
