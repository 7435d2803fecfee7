"""Force control along a path: admittance, tracking and record; validates its tasks."""
