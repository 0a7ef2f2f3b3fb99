"""For agents: a skill to install, and a server of read-only tools (Model Context Protocol)."""

from epicyclic.registry import PlugIn

PLUG_IN: PlugIn = {"commands": {"mcp": "commands:mcp", "skill": "commands:skill"}}
