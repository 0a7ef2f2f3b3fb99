"""Exit codes of the command."""

from __future__ import annotations

EXIT_DONE = 0
EXIT_ERROR, EXIT_INPUT, EXIT_NO_SOLUTION, EXIT_FAILED_POINTS = 1, 2, 3, 4
EXIT_INCOMPLETE = 5
EXIT_INTERRUPTED, EXIT_BROKEN_PIPE = 130, 141
