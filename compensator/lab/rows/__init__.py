"""The rows of a regression: every trial's signals and columns, filtered and thinned alike, and pictures of them."""
