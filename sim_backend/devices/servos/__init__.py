"""What servos on a serial bus have in common: several on one line, each with a joint of its own; position control."""
