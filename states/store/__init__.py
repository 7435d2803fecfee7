"""States that read and write the named entries of the store."""
