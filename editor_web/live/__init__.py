"""The live state of runs, arms and documents, folded from events and sent to pages as snapshots and deltas."""
