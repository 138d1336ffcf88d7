"""How every script of the workflow starts: its typed `main` is its command line."""

import logging
import sys
from collections.abc import Callable

import tyro

from placing.errors import PlacingError


def run(main: Callable[..., None]) -> None:
    """Call `main` with the command line; say in one line what a user got wrong."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    try:
        tyro.cli(main)
    except PlacingError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
    except KeyboardInterrupt:
        sys.exit(130)
