"""Robot Web Services 1.0 of an IRC5: what the controller says of itself over HTTP, and what a person may ask of it."""
