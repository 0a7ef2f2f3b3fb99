"""The case: what the user states about a gear set, validated into frozen SI objects."""
