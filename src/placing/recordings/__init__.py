"""Recordings of scenes for the rerun viewer."""
