"""The kinds of experiment: what a user starts, one kind per file."""
