"""From cases to machines, and from their solutions to results."""
