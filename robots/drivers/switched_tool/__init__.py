"""Tools on digital outputs of another device of the cell, as devices; `robots/switched` has their parts."""
