"""A master and a slave under one control loop."""
