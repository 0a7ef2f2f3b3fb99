"""The app: pages of a case in the browser."""

from epicyclic.registry import PlugIn

PLUG_IN: PlugIn = {"commands": {"app": "command:app"}}
