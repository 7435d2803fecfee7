"""The live state of runs, arms and documents, reduced from events and sent to pages as snapshots and deltas."""
