"""What all groups of skills share: plans off the event loop, one motion at a time, frames and deadlines."""
