"""Streams depend on the name of a job and on nothing else."""

import subprocess
import sys

import numpy as np

from placing.seeds import generator

DRAW = (
    "from placing.seeds import generator; print(generator(7, 'a', 'b').integers(1e9))"
)


def test_the_same_job_draws_the_same_numbers():
    first, second = generator(7, "job", "office1"), generator(7, "job", "office1")
    np.testing.assert_array_equal(first.normal(size=9), second.normal(size=9))


def test_drawing_for_one_job_leaves_the_others_alone():
    alone = generator(7, "job", "office2").normal(size=9)
    generator(7, "job", "office1").normal(size=1000)
    np.testing.assert_array_equal(generator(7, "job", "office2").normal(size=9), alone)


def test_seed_names_and_their_order_all_matter():
    jobs = [(7, "a", "b"), (8, "a", "b"), (7, "b", "a"), (7, "ab"), (7, "a"), (7,)]
    draws = {int(generator(*job).integers(2**62)) for job in jobs}
    assert len(draws) == len(jobs)


def test_streams_of_two_jobs_are_uncorrelated():
    first, second = generator(7, "office1"), generator(7, "office2")
    together = np.corrcoef(first.normal(size=20_000), second.normal(size=20_000))
    assert abs(together[0, 1]) < 0.03


def test_another_process_draws_the_same_numbers():
    command = [sys.executable, "-c", DRAW]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert int(done.stdout) == generator(7, "a", "b").integers(1e9)
