"""Results with everything that reports and plots show, and the files they are kept in."""
