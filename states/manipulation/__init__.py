"""States that take a part and put it down: the whole way there, the tool, and what is planned with."""
