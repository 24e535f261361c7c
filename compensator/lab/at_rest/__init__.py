"""The joint at rest: the effort of breaking away, and the efforts between which friction holds it."""
