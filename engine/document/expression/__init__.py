"""Expressions in documents: syntax, cost, compilation and evaluation."""
