"""The text of a document: what it says and where, and how it is written again with all other bytes kept."""
