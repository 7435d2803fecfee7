"""Measures of a simulated world: what its arms, tools and contacts sum up while it runs."""
