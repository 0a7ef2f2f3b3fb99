"""Loss maps over speed, torque and oil temperature, in the formats that simulations read."""
