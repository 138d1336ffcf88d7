"""What a robot carries out: which placements, in which order (Section 3.3)."""
