"""Model folders: their documents, calibration files, and their composition into one robot model."""
