"""Parametric meshes of furniture, objects and buildings, and what they can hold."""
