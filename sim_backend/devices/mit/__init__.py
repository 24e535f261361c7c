"""What simulated actuators of the MIT protocol have inside, whatever they say on the wire."""
