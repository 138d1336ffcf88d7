"""Placing areas: found in a cloud, and compared with true supports."""
