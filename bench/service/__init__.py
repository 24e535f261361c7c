"""The REST service and the page: the bench over HTTP, on loopback unless told otherwise."""
