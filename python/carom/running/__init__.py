"""A run: taken through time, looked at, recorded, gone on with."""
