"""What may touch, and by which laws: pairs, obstacles, friction."""
