"""What cameras see: simulated depth images, and the map of the space that something unknown takes up."""
