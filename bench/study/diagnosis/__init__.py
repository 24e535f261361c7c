"""What is missing from a model of a study: diagnoses, of one and of many, and the search."""
