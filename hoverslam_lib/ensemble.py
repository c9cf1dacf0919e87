"""Ensembles: one flight for each row of a descent with columns."""

import math

import numpy as np

from hoverslam_lib import _columns, _validate
from hoverslam_lib.descent import OUTCOMES, Descent, fly
from hoverslam_lib.ignition import NoSoftLanding, hover_height


def fly_all(descent, t_ignite, *, dt=0.1, method="rk4", controller=None):
    """Fly one flight for each row of the columns of a descent, and say what became of each.

    Row i is what `fly` and `hover_height` give for row i of the descent.

    Parameters
    ----------
    descent : Descent
        Any of its numbers may be a column: an array of length n, or a pandas Series.
    t_ignite : float, array_like of shape (n,), or None
        Ignition time [s], at least 0, as in `fly`; may be a column.
    dt : float
        Step size [s], greater than 0.
    method : str or callable
        A key of `METHODS`, or a step function of one's own.
    controller : callable, optional
        ``controller(t, h, v, mass)`` → throttle in [0, 1], as in `fly`, called with arrays of one length.
        ``np.vectorize`` makes one of a law for numbers.

    Returns
    -------
    pandas.DataFrame
        One row a flight, with the index of a pandas Series among the columns, else 0, 1, 2, …

        - "outcome": one of `OUTCOMES`, as a categorical
        - "hover height [m]": signed, as `hover_height`; nan where thrust does not exceed the dry weight. With a
          controller the height of `Flight.hover`, nan where the booster did not come to rest.
        - "touchdown time [s]", "touchdown velocity [m/s]": nan without a touchdown
        - "propellant left [kg]": at the end of the flight

    Raises
    ------
    ValueError, TypeError
        As `fly`; also if columns differ in length or in their pandas index.
    """
    import pandas as pd

    if not isinstance(descent, Descent):
        raise TypeError(f"descent must be a Descent; got {descent!r}")
    if isinstance(t_ignite, list | tuple | range):
        t_ignite = np.array(t_ignite)
    if t_ignite is not None:
        _validate.number_or_column("t_ignite", t_ignite, "s", least=0)
    columns = descent.columns | ({"t_ignite": t_ignite} if _validate.is_column(t_ignite) else {})
    _validate.one_length(columns)
    index = _index(columns)

    found = []
    for i in range(len(index)):
        one, t = descent.rows(i), _columns.taken(t_ignite, i) if "t_ignite" in columns else t_ignite
        law = controller and (lambda *state: controller(*(np.array([x]) for x in state)).item())
        flight = fly(one, t, dt=dt, method=method, controller=law)
        if controller is None:
            height = _hover_height(one, t, dt=dt, method=method)
        else:
            height = flight.hover[1] if flight.hover else math.nan
        left = flight.mass[-1] - one.booster.dry_mass
        found.append((flight.outcome, height, *(flight.touchdown or (math.nan, math.nan)), left))
    names = ["outcome", "hover height [m]", "touchdown time [s]", "touchdown velocity [m/s]", "propellant left [kg]"]
    table = pd.DataFrame(found, index=index, columns=names)
    return table.astype(dict.fromkeys(names[1:], float) | {"outcome": pd.CategoricalDtype(OUTCOMES)})


def _index(columns):
    import pandas as pd

    given = [(name, column.index) for name, column in columns.items() if isinstance(column, pd.Series)]
    for name, index in given[1:]:
        if not index.equals(given[0][1]):
            raise ValueError(f"the columns {given[0][0]} and {name} differ in their pandas index")
    return given[0][1] if given else pd.RangeIndex(len(next(iter(columns.values()), [0])))


def _hover_height(descent, t_ignite, **settings):
    try:
        return math.nan if t_ignite is None else hover_height(descent, t_ignite, **settings)
    except NoSoftLanding:  # thrust does not exceed the dry weight
        return math.nan
