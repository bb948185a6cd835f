"""What drives bodies: loads, supports and springs."""
