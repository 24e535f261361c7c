"""From a joint of which little is known to a bench.toml that compensates: asks, pushes, identifies, proposes, tries.

It moves nothing itself: every motion is an experiment of the bench, recorded, limited, and stopped as any other.
"""
