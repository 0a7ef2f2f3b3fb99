"""The app: pages of a case in the browser."""
