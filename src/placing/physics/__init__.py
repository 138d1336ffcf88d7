"""Rigid-body simulation: does what was placed stay put?"""
