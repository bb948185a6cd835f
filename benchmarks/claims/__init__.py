"""Every number of the documentation, measured again: see ``__main__``."""
