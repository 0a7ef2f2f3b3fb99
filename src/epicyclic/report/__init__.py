"""Results as tables for a terminal. Only reads results; computes nothing."""
