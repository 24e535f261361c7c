"""The blind benchmark: the model lab on joints that it knows nothing of, and how often it is right."""
