"""The physical effects, one file each."""
