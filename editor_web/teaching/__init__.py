"""The server's side of the page on which arms are taught: what it is told, and what stops when it dies."""
