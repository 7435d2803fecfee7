"""From text to checked data and back: strict YAML with positions, decoding into frozen models, mistakes."""
