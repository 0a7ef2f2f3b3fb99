"""Published figures, and what this package computes for them."""
