"""The control loop in a process of its own, apart from the server: nothing that is served holds it up."""
