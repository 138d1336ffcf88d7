"""What a recording holds, read back."""

from collections import Counter

from rerun.chunk import RrdReader


def count_rows(path):
    """Return the number of rows of each entity of a recording, static ones too."""
    rows = Counter()
    for chunk in RrdReader(path).stream():
        rows[chunk.entity_path] += chunk.num_rows
    return dict(sorted(rows.items()))
