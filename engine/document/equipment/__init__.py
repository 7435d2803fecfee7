"""Equipment documents: pins under the names of their services; and the files of ReconCycle that say the same."""
