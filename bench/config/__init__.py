"""What a bench is told: rig, drive, limits, servo, and what known loads and friction curves tell of the joint.

It reads and checks; it moves nothing, opens no drive and no store.
"""
