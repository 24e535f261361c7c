"""The trials that would tell the rivals apart."""
