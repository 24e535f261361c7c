"""What could be missing, as columns, and the evidence for each, against noise learnt from the rows."""
