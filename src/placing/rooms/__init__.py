"""The data set `rooms`: room files, labelled arrangements and their checks."""
