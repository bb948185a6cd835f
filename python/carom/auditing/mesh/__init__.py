"""Cells and facets as the auditor sees them, and the meshes that a case draws."""
