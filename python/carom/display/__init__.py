"""How numbers, times, tables and markup are written, for terminals, pages and notebooks alike."""
