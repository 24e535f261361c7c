"""What routes take and answer with, as pydantic models.

Data only.
"""
