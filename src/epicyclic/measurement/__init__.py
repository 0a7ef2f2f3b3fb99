"""Measured losses against the model, and fits of uncertain inputs to them."""
