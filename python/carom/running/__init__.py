"""A run: taken through time, observed, recorded, resumed."""
