"""What `friction-bench doctor` finds out about a drive, before and without an experiment."""
