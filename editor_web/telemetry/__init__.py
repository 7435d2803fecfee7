"""What a page subscribes to besides the run: bus metrics, topic messages, plotted signals.

Userdata and goal progress.
"""
