"""REXS files: gears from them, results into them."""

from epicyclic.registry import PlugIn

PLUG_IN: PlugIn = {
    "commands": {"rexs": "commands:rexs"},
    "case_readers": dict.fromkeys(
        (".rexs", ".rexs.xml", ".rexsj", ".rexs.json", ".rexsz", ".rexs.zip"), "importing:read_rexs"
    ),
}
