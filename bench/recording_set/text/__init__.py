"""CSV and TOML as recording sets use them: cells, numbers, columns, errors with file, line and column.

It knows the format, not what the numbers mean.
"""
