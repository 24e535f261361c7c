"""A CAN bus of python-can, opened, used and closed in bounded time; it knows no protocol."""
