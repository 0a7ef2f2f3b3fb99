"""Published figures, and what this package computes for them."""

from epicyclic.registry import PlugIn

PLUG_IN: PlugIn = {
    "commands": {
        "validate": "commands:validate",
        "reproduce": "commands:reproduce",
        "study": "commands:study",
    },
    "plans": {"study": "pocketing:StudyPlan"},
    "plan_writers": {"study": "commands:study_writer"},
}
