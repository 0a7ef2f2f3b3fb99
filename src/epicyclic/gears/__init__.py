"""Gears: geometry, flanks, tools and what is measured on them, as plain numbers."""
