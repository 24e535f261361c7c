"""What keeps a store in order: import and removal, retention, copies, free space, records whose process died.

Nothing here interprets what was measured.
"""
