"""Many cases: what varies, how they are run, and the dataset they make."""
