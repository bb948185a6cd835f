"""Functions that a case gives by formulas and tables, as the auditor reads them."""
