"""A behavior of one cell written anew for another one: the names it uses, what they become, the new documents."""
