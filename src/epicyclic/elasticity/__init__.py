"""Compliance of gear teeth: bending of a tooth as a plate, its foundation, and the contact."""
