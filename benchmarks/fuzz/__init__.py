"""Whether bad input is ever answered by anything but one line and an exit status.

``python benchmarks/fuzz [COUNT] [FIRST SEED]`` spoils valid case files, mesh files and contact
problems at random, and hands each to what the commands do. What is allowed: the input is taken, or
one line and exit status 2, or, of a step that does not converge, exit status 3.
"""
