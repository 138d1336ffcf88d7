"""Errors a user can cause: each is one line that names thing, value and expectation."""

from difflib import get_close_matches

MOST_LISTED = 60
"""Names that are listed, as all kinds of furniture; of more the nearest are told."""
N_NEAREST = 5


class PlacingError(Exception):
    """Something a user gave is wrong; the message is one complete line."""


class BadInput(PlacingError):
    """A file, a field or a value given by a user is not what is expected."""


class NoFloor(BadInput):
    """A robot can stand nowhere in a scene."""


class BadArtifact(PlacingError):
    """A file that a stage wrote is missing, damaged or of another shape."""


class UnknownName(PlacingError):
    """A scene, category, method or kind does not exist; the message lists what does."""


def unknown(what: str, name: str, known: list[str]) -> UnknownName:
    """Return the error for `name`, which is none of the `known` ones."""
    names = sorted(known)
    said = "known are"
    if len(names) > MOST_LISTED:
        said = f"of {len(names)} that are known the nearest are"
        names = get_close_matches(name, names, N_NEAREST, cutoff=0.0)
    return UnknownName(f"unknown {what} {name!r}; {said} {', '.join(names)}")
