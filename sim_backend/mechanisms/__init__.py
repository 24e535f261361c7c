"""The physical mechanisms of the plant, one a file: parameters with units, and the law as compiled functions.

They know neither the model lab nor each other.
"""
