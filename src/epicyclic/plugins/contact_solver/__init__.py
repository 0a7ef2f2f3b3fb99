"""The solver of line contacts, and campaigns of simulated contacts of an oil."""

from epicyclic.registry import PlugIn

PLUG_IN: PlugIn = {
    "commands": {"contact": "commands:contact", "oil": "commands:oil"},
    "friction_models": {"ehl-direct": "direct:friction_of"},
    "plans": {"oil": "campaign:Campaign"},
    "plan_writers": {"oil": "commands:campaign_writer"},
}
