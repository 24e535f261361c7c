"""Pages of the reference that are written from the code, each time that the documents are built.

Every module makes Markdown text out of what the program itself uses; nothing here is a second list of it.
"""
