"""REXS files: gears from them, results into them."""
