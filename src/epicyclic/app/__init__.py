"""App: forms, tables and figures of a case in the browser, served to this machine only."""
