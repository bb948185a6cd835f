"""Deliberate errors, to see whether the tests notice."""
