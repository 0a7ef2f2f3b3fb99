"""How well a result is known, given how well its inputs and models are."""
