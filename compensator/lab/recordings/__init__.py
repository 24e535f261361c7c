"""From channels over time to filtered signals: what comes in, checked, and what the joint remembers at each moment."""
