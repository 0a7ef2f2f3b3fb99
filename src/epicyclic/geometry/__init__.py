"""Gears, meshes and contact lines as plain numbers."""
