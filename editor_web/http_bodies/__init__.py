"""The request and response bodies of the HTTP interface, by subject; data only."""
