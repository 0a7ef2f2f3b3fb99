"""How well losses are known."""
