"""Steps as the auditor computes them again: states, contacts, forces, work and tolerances."""
