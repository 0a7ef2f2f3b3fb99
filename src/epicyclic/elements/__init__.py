"""Elements of a gearbox: what loses power, each with its physics, figures and flags in one module.

An element sees a `State` and nothing else: no case, no other element.
"""
