"""Poses of people, hallucinated by a Dirichlet process mixture."""
