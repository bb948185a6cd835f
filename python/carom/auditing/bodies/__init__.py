"""Bodies as the auditor sees them: forces, energies and momenta of their states."""
