"""The standard skills: the interface between states and robots, which do not import each other."""
