"""Edits as messages, and what each of them does to a draft."""
