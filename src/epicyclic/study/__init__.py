"""What is asked of a case: its losses, details, sweeps, maps, bands, measurements."""
