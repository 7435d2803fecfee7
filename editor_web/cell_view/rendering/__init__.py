"""Rendering with viser: the gateway to its server, canvases, layer groups, transforms, geometry and colours."""
