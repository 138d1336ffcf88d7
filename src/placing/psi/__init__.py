"""Psi_object: whether a placement is stable and an object belongs there (eq. 1)."""
