"""Units of one kind: what is common to them, how they scatter, and which of them is an outlier."""
