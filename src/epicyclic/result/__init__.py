"""Results: losses, speeds, torques and figures, as objects and as JSON."""
