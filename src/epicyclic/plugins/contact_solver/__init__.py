"""The solver of line contacts, and campaigns of simulated contacts of an oil."""
