"""Characterising an oil: simulations of contacts over a design, and the models fitted to them."""
