"""A master and a slave: two joints, two drives, one loop."""
