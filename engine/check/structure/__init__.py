"""Findings about nodes and their transitions: what ends, what is reached, what loops, who waits for whom."""
