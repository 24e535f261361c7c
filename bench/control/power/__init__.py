"""What stands between a joint and its power: safe torque off, which takes it away at any time."""
