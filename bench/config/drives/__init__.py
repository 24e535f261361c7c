"""The `[drive]` section of bench.toml: what a kind of drive brings in, and which kinds are installed.

It knows no kind by name: the kinds are entry points, ours (`bench.drives`) as those of other packages.
"""
