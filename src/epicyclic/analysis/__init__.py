"""From a case to its result: the only place that combines the loss models."""
