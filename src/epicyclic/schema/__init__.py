"""Tables of files: their classes, what a schema says of keys, reading, problems in words."""
