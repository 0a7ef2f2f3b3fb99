"""Compiled numerics on plain arrays."""
