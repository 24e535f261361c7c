"""Rows of the tables, one table or group of tables a file.

Each function works inside the transaction of its caller; none opens one.
"""
