"""The command `epicyclic`: options, calls, printed output."""
