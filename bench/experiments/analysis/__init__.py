"""What the readings of a procedure tell: fits, checks and results.

Arrays and numbers in, results out; nothing moves.
"""
