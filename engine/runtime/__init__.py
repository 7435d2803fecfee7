"""Executes behaviors: plans, runs, their nodes and trees, operator control, resume and hot change."""
