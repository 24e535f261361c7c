"""Commands of the model lab: studies, effects, challenges.

They parse words and print answers; the work is done in `bench.study`.
"""
