"""From what the user states to a machine: planetary sets, gear pairs, trains of both."""
