"""Surfaces that points are checked against, and where points are closest to them."""
