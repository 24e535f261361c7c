"""What holds for many routes: problem details, conditional requests, pages, the page and its files, OpenAPI.

It knows HTTP and nothing of benches.
"""
