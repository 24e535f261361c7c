"""A study in one go, for a colleague: what the data can and cannot tell, what was missing, what to record next.

It uses the steps of `bench.study` as they are, and judges nothing by itself.
"""
