"""Ratings by people who do not know which method made an arrangement."""
