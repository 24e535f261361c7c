"""Challenges: recordings of a simulated joint that hides something, and the sealed answer beside them."""
