"""Has a change made the bench worse? A small fixed campaign on the simulated bench, beside a stored baseline."""
