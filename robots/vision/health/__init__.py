"""Whether the images of a camera can be relied on: against image statistics, stamps and the known geometry."""
