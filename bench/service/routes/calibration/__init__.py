"""Routes of calibrations: kept ones, and the run that measures for a new one."""
