"""What a model leaves of the effort: whether it is more than noise, and in what way, whatever the catalogue says."""
