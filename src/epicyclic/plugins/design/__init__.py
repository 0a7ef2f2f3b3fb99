"""Choosing gears: safety factors, masses, relief, and the search for designs."""

from epicyclic.registry import PlugIn

PLUG_IN: PlugIn = {
    "commands": {
        "strength": "commands:strength",
        "design": "commands:design",
        "relief": "commands:relief",
    },
    "details": {"strength": "tables:strength_tables"},
}
