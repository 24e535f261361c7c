"""The same work on many items: in processes of this machine, or on a Dask cluster.

It knows nothing of what the work is.
"""
