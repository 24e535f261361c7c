"""Routes of studies: made and changed, checked, carried on in rounds, and what is computed from them."""
