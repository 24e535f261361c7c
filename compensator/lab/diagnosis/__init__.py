"""The answer: one effect, a class, something unknown, or nothing; problems of the data first; several effects."""
