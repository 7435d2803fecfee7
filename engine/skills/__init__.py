"""The standard skills: the interface between states and robots, which do not import each other.

Each file is the face of its subject, so that a state loads only what it asks for.
"""
