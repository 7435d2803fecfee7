"""The composition root: sessions, and the one place that starts, resumes and replaces runs."""
