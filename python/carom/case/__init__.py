"""The case: what a file or a program says of it, one module per table, joined in the scenario."""
