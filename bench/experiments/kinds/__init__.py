"""The kinds of experiment: what a user starts, one kind a file.

Each is parameters and a procedure; what several of them need is in `parts` and `analysis`.
"""
