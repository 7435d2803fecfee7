"""The kinds of nodes of a behavior: their fields, their shape, and what check, editor and page know of them."""
