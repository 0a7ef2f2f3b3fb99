"""Measured losses beside computed ones."""
