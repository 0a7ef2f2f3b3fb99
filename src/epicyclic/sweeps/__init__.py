"""Many cases: the full product of swept keys, in parallel, with failures kept and work resumed."""
