"""CiA 301: bus, SDO, PDO, SYNC, heartbeat, EMCY.

It knows frames and objects, not what a drive does with them.
"""
