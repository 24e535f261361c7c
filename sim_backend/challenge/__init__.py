"""Plants drawn at random, with mechanisms hidden in them. Knows nothing of whoever will explain the data."""
