"""One module per code, imported only by the process that runs it; each has a function `run`."""
