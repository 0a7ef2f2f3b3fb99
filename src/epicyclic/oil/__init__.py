"""Oils: what is stated of one, and its properties at a temperature."""
