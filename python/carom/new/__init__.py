"""Cases to begin with."""
