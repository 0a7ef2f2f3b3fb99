"""Elastohydrodynamic line contacts solved numerically."""
