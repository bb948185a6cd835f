"""carom and other codes on the same problems, side by side: ``python benchmarks/compare``."""
