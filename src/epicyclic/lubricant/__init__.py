"""Oils as data, and their properties at temperature."""
