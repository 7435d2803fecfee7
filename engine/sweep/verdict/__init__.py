"""What a sweep proves: whether what is required is reached, and whether a version is worse than another one."""
