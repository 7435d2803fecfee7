"""The equipment server of a module's computer: pins under names, with safe values that no client can leave behind."""
