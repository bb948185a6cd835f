"""The files of a results directory, written and read."""
