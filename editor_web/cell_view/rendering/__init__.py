"""What viser draws with: the gateway to its server, canvases, layer groups, transforms, geometry and colours."""
