"""Plug-ins: what the core works without and never imports."""
