"""Laws of materials as the auditor writes them."""
