"""Temperatures: flash and bulk temperature of flanks, heat of discs, contacts and housings.

Formulas in numbers, SI units and kelvin. They know no case, no state and no part.
"""
