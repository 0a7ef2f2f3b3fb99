"""Friction and rolling loss of one oil fitted to solved contacts, as a file that cases take."""
