"""The `[drive]` section of bench.toml: one file per kind of drive."""
