"""Contacts: line contacts of flanks and rollers, elastic teeth, temperatures."""
