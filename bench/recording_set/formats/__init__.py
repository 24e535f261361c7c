"""Recordings in files that are no text: MATLAB, numpy, HDF5, Parquet, JSON lines, read to named columns by libraries.

It knows nothing of channels and units; what a column means is said in the mapping.
"""
