"""What to record next: trials of the bench, run on the fitted model first, and those that tell most."""
