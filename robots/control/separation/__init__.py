"""Speed and separation monitoring in the control loop: an arm's speed follows its distance from people."""
