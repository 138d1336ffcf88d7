"""Streams of recordings whose content does not depend on when it is written."""

from collections.abc import Iterable

import rerun as rr


def recording_stream(names: Iterable[str]) -> rr.RecordingStream:
    """Return a stream with an identifier made of names, and with strict checks."""
    rr.set_strict_mode(True)
    stream = rr.RecordingStream(
        "placing",
        recording_id="-".join(names),
        send_properties=False,
        # Batches that end after some milliseconds differ on a busy machine.
        batcher_config=rr.ChunkBatcherConfig.NEVER(),
    )
    stream.set_log_time_enabled(False)
    return stream
