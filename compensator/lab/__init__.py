"""Model lab: compare a friction model with measurements, find what is missing, add it."""
