"""The tables of the object dictionary, as data."""
