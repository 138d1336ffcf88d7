"""The methods that arrange: where each puts the objects, and how sure it is."""
