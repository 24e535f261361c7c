"""A model fitted to rows, and how wrong it is on others."""
