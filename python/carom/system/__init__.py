"""What surrounds a run: files that are there, signals, threads, packages that may be missing."""
