"""What the plots of a study are made of: series over time, the error map, and the moments behind it."""
