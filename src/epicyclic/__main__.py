"""``python -m epicyclic``."""

from epicyclic.cli.main import main

if __name__ == "__main__":
    main()
