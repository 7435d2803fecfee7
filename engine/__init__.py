"""The engine: documents, runs, bus, journal and store; knows no robot and no browser."""
