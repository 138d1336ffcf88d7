"""Robotic placement of objects by hallucinating the people who will use them."""
