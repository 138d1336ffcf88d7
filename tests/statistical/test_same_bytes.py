"""The same seed gives the same bytes: in every process and on every processor."""

import os
import subprocess
import sys

import pytest

PROGRAM = """
import hashlib
import numpy as np
from placing import seeds
from placing.people import dpmm

rng = np.random.default_rng(0)
rows = rng.random((6, 500), np.float32)
rows, prior = rows * rows * rows, rng.dirichlet(np.ones(500))
digest = hashlib.sha256()
slot = np.array([-1, -1, -1, -1, -1, 0])
for sampler in ("exact_birth", "algorithm8"):
    for n_components in (0, 4):
        config = dpmm.DpmmConfig(sampler, 1.0, 3, 2, 10, 300)
        rng = seeds.generator(0, sampler)
        chains = dpmm.sample(rng, rows, prior, config, slot, n_components)
        for value in vars(chains).values():
            digest.update(value.tobytes())
print(digest.hexdigest())
"""


def digest_of(**changed):
    """Return the digest of chains run in a process of its own."""
    env = {k: v for k, v in (os.environ | changed).items() if v}
    command = [sys.executable, "-c", PROGRAM]
    out = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    assert len(out.stdout) == 65
    return out.stdout


def test_the_same_seed_gives_the_same_bytes_in_every_process():
    assert digest_of() == digest_of(PYTHONHASHSEED="7")


@pytest.mark.slow  # it compiles the sampler a second time
def test_code_for_this_processor_gives_the_bytes_of_code_for_any(tmp_path):
    own = {"NUMBA_CPU_NAME": "", "NUMBA_CACHE_DIR": str(tmp_path / "own")}
    own["NPY_DISABLE_CPU_FEATURES"] = ""
    assert digest_of(**own) == digest_of(NUMBA_CPU_NAME="generic")
