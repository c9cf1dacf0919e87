"""Beyond one process: the way that the README documents, on real worker processes, one of which dies on the way."""

import os
import signal
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from hoverslam_lib import LANDING_BURN, fly_all

dd = pytest.importorskip("dask.dataframe", reason="the extra 'cluster' is not installed")
distributed = pytest.importorskip("distributed", reason="the extra 'cluster' is not installed")

FLIGHTS = 10_000
SIGMA = {"thrust": 0.01, "drag": 0.10, "delay": 0.05}


def draw(block, seed):
    """A block of random errors, of a seed of its own."""
    normal = np.random.default_rng(seed).normal(size=(FLIGHTS, len(SIGMA)))
    return pd.DataFrame(
        normal * list(SIGMA.values()), columns=list(SIGMA), index=pd.RangeIndex(FLIGHTS) + block * FLIGHTS
    )


def land(errors):
    booster = replace(
        LANDING_BURN.booster,
        thrust=LANDING_BURN.booster.thrust * (1 + errors["thrust"]),
        drag_coefficient=LANDING_BURN.booster.drag_coefficient * (1 + errors["drag"]),
    )
    return fly_all(replace(LANDING_BURN, booster=booster), 17.5 + errors["delay"])


def test_a_cluster_that_loses_a_worker_gives_the_table_of_one_process():
    seeds = np.random.SeedSequence(12).spawn(8)
    errors = dd.from_map(draw, range(8), seeds)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        before = client.run(os.getpid)
        flown = distributed.futures_of(client.persist(errors.map_partitions(land)))
        done, under_way = distributed.wait(flown, return_when="FIRST_COMPLETED")
        assert len(under_way) >= 2
        ((owner, *_),) = client.who_has(list(done)[:1]).values()  # what it has made is lost, and what it is making
        os.kill(before[owner], signal.SIGKILL if hasattr(signal, "SIGKILL") else signal.SIGTERM)
        table = pd.concat(client.gather(flown))
        assert before[owner] not in client.run(os.getpid).values()
    alone = land(pd.concat([draw(block, seed) for block, seed in enumerate(seeds)]))
    assert len(table) == 8 * FLIGHTS
    assert table["outcome"].nunique() > 1
    pd.testing.assert_frame_equal(table, alone, check_exact=True)
