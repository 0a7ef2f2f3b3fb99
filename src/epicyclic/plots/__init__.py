"""Plots: functions that draw one question each on matplotlib Axes and return them."""
